// SPDX-License-Identifier: BSD-3-Clause
// picture_difference A.png B.png: prints the largest difference of a channel, 0 to 255. Exits with
// 1 if the pictures differ in size or cannot be read.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <rastrum/io.hpp>

int main(int count, char** arguments) {
  using rastrum::Rgba8;
  try {
    if (count != 3) return 1;
    const rastrum::Image<Rgba8> a = rastrum::io::read_image(arguments[1]);
    const rastrum::Image<Rgba8> b = rastrum::io::read_image(arguments[2]);
    if (a.width() != b.width() || a.height() != b.height()) return 1;
    int most = 0;
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
      const Rgba8 p = a.pixels()[i], q = b.pixels()[i];
      most = std::max({most, std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b),
                       std::abs(p.a - q.a)});
    }
    std::printf("%d\n", most);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
