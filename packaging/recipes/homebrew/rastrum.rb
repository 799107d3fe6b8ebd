# Untried (../README.md). On macOS the library has been compiled and linked, and not run.
class Rastrum < Formula
  desc "Software rendering of meshes and terrains, exact, without OpenGL or GPU"
  homepage "https://github.com/OWNER/rastrum"
  url "https://github.com/OWNER/rastrum/archive/refs/tags/v0.1.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license all_of: ["BSD-3-Clause", "Bitstream-Vera", "Apache-2.0", "CC0-1.0"]
  head "https://github.com/OWNER/rastrum.git", branch: "main"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "highway"
  depends_on "jpeg-turbo"
  depends_on "libdeflate"
  depends_on "libpng"
  depends_on :linux
  depends_on "nlohmann-json"
  depends_on "openexr"
  depends_on "tbb"
  depends_on "zlib"

  def install
    args = %w[TESTS EXAMPLES BENCH].map { |part| "-DRASTRUM_BUILD_#{part}=OFF" }
    args << "-DRASTRUM_WINDOW=OFF"
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", *args, *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"rastrum", "render", "builtin:teapot", "--size", "320x240", "-o", "teapot.png"
    assert_path_exists testpath/"teapot.png"
  end
end
