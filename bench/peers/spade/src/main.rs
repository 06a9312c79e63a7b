//! Meshes a .poly file with spade: spade_mesh INPUT ANGLE AREA [BASE]. AREA 0: no bound; ANGLE 0: Delaunay
//! triangulation only. Prints the seconds from points and segments in memory to the mesh; writes BASE.node, .ele,
//! .poly.
//! The input is plain: numbered from 0, no attributes, no markers, no comments.
use spade::{
    handles::{FixedFaceHandle, InnerTag},
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};
use std::collections::HashSet;
use std::io::{BufWriter, Write};
use std::time::Instant;

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>>;

fn read(path: &str) -> (Vec<Point2<f64>>, Vec<[usize; 2]>) {
    let text = std::fs::read_to_string(path).expect("input");
    let mut lines = text.lines().map(|l| l.split_whitespace().collect::<Vec<_>>());
    let count = |row: Option<Vec<&str>>| row.map_or(0, |r| r[0].parse::<usize>().unwrap());
    let n = count(lines.next());
    let points = (0..n)
        .map(|_| lines.next().unwrap())
        .map(|r| Point2::new(r[1].parse().unwrap(), r[2].parse().unwrap()))
        .collect();
    let m = count(lines.next());
    let segments = (0..m)
        .map(|_| lines.next().unwrap())
        .map(|r| [r[1].parse().unwrap(), r[2].parse().unwrap()])
        .collect();
    (points, segments)
}

fn write(base: &str, cdt: &Cdt, outside: &HashSet<FixedFaceHandle<InnerTag>>) -> std::io::Result<()> {
    let create = |suffix| std::fs::File::create(format!("{base}{suffix}")).map(BufWriter::new);
    let mut node = create(".node")?;
    writeln!(node, "{} 2 0 0", cdt.num_vertices())?;
    for v in cdt.vertices() {
        writeln!(node, "{} {:?} {:?}", v.index(), v.position().x, v.position().y)?;
    }
    let inside: Vec<_> = cdt.inner_faces().filter(|f| !outside.contains(&f.fix())).collect();
    let mut ele = create(".ele")?;
    writeln!(ele, "{} 3 0", inside.len())?;
    for (i, f) in inside.iter().enumerate() {
        let [a, b, c] = f.vertices().map(|v| v.index());
        writeln!(ele, "{i} {a} {b} {c}")?;
    }
    let edges: Vec<_> = cdt.undirected_edges().filter(|e| e.is_constraint_edge()).collect();
    if edges.is_empty() {
        return Ok(());
    }
    let mut poly = create(".poly")?;
    writeln!(poly, "0 2 0 0\n{} 0", edges.len())?;
    for (i, e) in edges.iter().enumerate() {
        let [a, b] = e.vertices().map(|v| v.index());
        writeln!(poly, "{i} {a} {b}")?;
    }
    writeln!(poly, "0")
}

fn main() -> std::io::Result<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let (points, segments) = read(&arguments[1]);
    let (angle, area): (f64, f64) = (arguments[2].parse().unwrap(), arguments[3].parse().unwrap());
    let holes = !segments.is_empty();
    let start = Instant::now();
    let mut cdt = Cdt::bulk_load_cdt(points, segments).expect("triangulation");
    let mut outside = HashSet::new();
    if angle > 0.0 {
        let mut bounds = RefinementParameters::<f64>::new()
            .exclude_outer_faces(holes)
            .with_max_additional_vertices(1 << 28)
            .with_angle_limit(AngleLimit::from_deg(angle));
        if area > 0.0 {
            bounds = bounds.with_max_allowed_area(area);
        }
        outside = cdt.refine(bounds).excluded_faces.into_iter().collect();
    }
    println!("{{\"seconds\": {}}}", start.elapsed().as_secs_f64());
    arguments.get(4).map_or(Ok(()), |base| write(base, &cdt, &outside))
}
