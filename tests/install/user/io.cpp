// SPDX-License-Identifier: BSD-3-Clause
// A program that reads files.
#include <rastrum/io.hpp>

int main() {
  return rastrum::io::scene_formats().size() > 4 ? 0 : 1;
}
