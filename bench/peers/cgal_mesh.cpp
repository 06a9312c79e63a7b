// Meshes a .poly file with CGAL: cgal_mesh INPUT ANGLE AREA [BASE]. AREA 0: no bound. Without segments: Delaunay
// triangulation only. Prints the seconds from points and segments in memory to the mesh; writes BASE.node, .ele, .poly.
// The input is plain: numbered from 0, no attributes, no markers, no comments.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = CGAL::Delaunay_triangulation_2<Kernel>;
using Data = CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>,
                                                  CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Mesh = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Data>;
using Point = Kernel::Point_2;

// A model of CGAL's concept MeshingCriteria_2: bounds on areas and on the smallest angle, as other programs have them.
struct Bounds {
    double area, sine2; // squared sine of the smallest angle

    // The smallest element comes first: the triangle that exceeds its area bound most, then the smallest angle.
    struct Quality {
        double excess, sine2;
        bool operator<(const Quality &q) const
        {
            return excess != q.excess ? excess > q.excess : sine2 < q.sine2;
        }
    };

    struct Is_bad {
        double area, sine2;

        CGAL::Mesh_2::Face_badness operator()(const Quality &q) const
        {
            if (q.excess > 1)
                return CGAL::Mesh_2::IMPERATIVELY_BAD;
            return q.sine2 < sine2 ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
        }

        CGAL::Mesh_2::Face_badness operator()(const Mesh::Face_handle &f, Quality &q) const
        {
            const Point &a = f->vertex(0)->point(), &b = f->vertex(1)->point(), &c = f->vertex(2)->point();
            double u = CGAL::squared_distance(a, b), v = CGAL::squared_distance(b, c), w = CGAL::squared_distance(c, a);
            double twice = 2 * CGAL::area(a, b, c), least = std::min({u, v, w});
            q.excess = area > 0 ? std::max(1.0, 0.5 * twice / area) : 1;
            q.sine2 = twice * twice * least / (u * v * w);
            return (*this)(q);
        }
    };

    Is_bad is_bad_object() const { return {area, sine2}; }
};

struct Input {
    std::vector<Point> points, holes;
    std::vector<std::pair<std::size_t, std::size_t>> segments;
};

static void read_points(std::FILE *file, std::vector<Point> &points)
{
    long n = 0, skipped;
    double x, y;
    if (std::fscanf(file, "%ld%*[^\n]", &n) != 1)
        n = 0;
    for (long i = 0; i < n && std::fscanf(file, "%ld %lf %lf", &skipped, &x, &y) == 3; i++)
        points.emplace_back(x, y);
}

static Input read(const char *path)
{
    Input input;
    std::FILE *file = std::fopen(path, "r");
    if (!file)
        std::exit(2);
    read_points(file, input.points);
    long m = 0, skipped, a, b;
    if (std::fscanf(file, "%ld%*[^\n]", &m) != 1)
        m = 0;
    for (long i = 0; i < m && std::fscanf(file, "%ld %ld %ld", &skipped, &a, &b) == 3; i++)
        input.segments.emplace_back(a, b);
    read_points(file, input.holes);
    std::fclose(file);
    return input;
}

// The domain consists of all faces if there are no segments.
template <class Triangulation>
static void write(const std::string &base, const Triangulation &mesh, bool marked)
{
    std::unordered_map<typename Triangulation::Vertex_handle, std::size_t> number;
    std::ofstream node(base + ".node"), ele(base + ".ele");
    node.precision(17);
    node << mesh.number_of_vertices() << " 2 0 0\n";
    for (auto v : mesh.finite_vertex_handles()) {
        std::size_t i = number.size();
        number[v] = i;
        node << i << ' ' << v->point() << '\n';
    }
    std::size_t n = 0, i = 0;
    auto inside = [&](auto f) {
        if constexpr (std::is_same_v<Triangulation, Mesh>)
            return !marked || f->is_in_domain();
        return true;
    };
    for (auto f : mesh.finite_face_handles())
        n += inside(f);
    ele << n << " 3 0\n";
    for (auto f : mesh.finite_face_handles())
        if (inside(f))
            ele << i++ << ' ' << number[f->vertex(0)] << ' ' << number[f->vertex(1)] << ' ' << number[f->vertex(2)]
                << '\n';
    if constexpr (std::is_same_v<Triangulation, Mesh>) {
        std::string rows;
        std::size_t m = 0;
        for (auto e = mesh.constrained_edges_begin(); e != mesh.constrained_edges_end(); ++e, ++m)
            rows += std::to_string(m) + ' ' + std::to_string(number[e->first->vertex(mesh.cw(e->second))]) + ' ' +
                    std::to_string(number[e->first->vertex(mesh.ccw(e->second))]) + '\n';
        std::ofstream(base + ".poly") << "0 2 0 0\n" << m << " 0\n" << rows << "0\n";
    }
}

int main(int argc, char **argv)
{
    if (argc < 4)
        return 2;
    Input input = read(argv[1]);
    double angle = std::atof(argv[2]), area = std::atof(argv[3]), pi = std::acos(-1.0);
    auto start = std::chrono::steady_clock::now();
    auto say = [&] {
        std::printf("{\"seconds\": %.6f}\n",
                    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    };
    if (input.segments.empty()) {
        Points mesh(input.points.begin(), input.points.end());
        say();
        if (argc > 4)
            write(argv[4], mesh, false);
        return 0;
    }
    Mesh mesh;
    mesh.insert_constraints(input.points.begin(), input.points.end(), input.segments.begin(), input.segments.end());
    double sine = std::sin(angle * pi / 180);
    CGAL::refine_Delaunay_mesh_2(mesh, input.holes.begin(), input.holes.end(), Bounds{area, sine * sine});
    say();
    if (argc > 4)
        write(argv[4], mesh, true);
    return 0;
}
