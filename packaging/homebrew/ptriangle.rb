class Ptriangle < Formula
  desc "Two-dimensional quality mesh generator and Delaunay triangulator"
  homepage "https://ptriangle.invalid"
  url "https://ptriangle.invalid/releases/ptriangle-0.2.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000" # of the release archive: none exists yet
  license "MIT"

  depends_on "cmake" => :build
  depends_on "cairo"
  depends_on "jansson"

  on_linux do
    depends_on "zlib"
  end

  def install
    args = %w[
      -DBUILD_SHARED_LIBS=OFF
      -DPTRIANGLE_HDF5=OFF
      -DPTRIANGLE_MPI=OFF
      -DPTRIANGLE_OPENMP=OFF
      -DPTRIANGLE_PREFIX=pt-
    ]
    system "cmake", "-S", ".", "-B", "build", *args, *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"square.poly").write <<~EOS
      4 2 0 0
      1 0 0
      2 1 0
      3 1 1
      4 0 1
      4 0
      1 1 2
      2 2 3
      3 3 4
      4 4 1
      0
    EOS
    system bin/"ptriangle", "-pq30a0.01Q", "square.poly"
    system bin/"pt-trianglecheck", "square.1", "--poly", "square.poly", "--min-angle", "30"
    system bin/"pt-meshplot", "square.1", "-o", "square.png"
    assert_path_exists testpath/"square.png"
    (testpath/"version.c").write <<~EOS
      #include <ptriangle/tri.h>
      int main(void) { return tri_version()[0] == 0; }
    EOS
    system ENV.cc, "version.c", "-I#{include}", "-L#{lib}", "-lpt-triangle", "-lm", "-o", "version"
    system "./version"
  end
end
