// Troubles that users of renderers have reported, rebuilt with geometry of our own: one row says
// what is odd about the input, what is right, and which rule says so. The tables are the other
// files of this folder; troubles of the Python package stand in python/tests/test_odd.py.
#pragma once

#include <vector>

namespace rastrum::odd {

struct Trouble {
  const char* name;   ///< `Format_WhatIsOdd`; a test's name: letters, digits and _
  const char* input;  ///< what is odd, in words
  const char* right;  ///< what must happen, and the rule or format that says so
  void (*check)();    ///< expectations of GoogleTest
};

std::vector<Trouble> fault_troubles();     ///< hostile files, and what is in the way
std::vector<Trouble> file_troubles();      ///< files that are valid but rare
std::vector<Trouble> document_troubles();  ///< files that name others, budgets, height maps
std::vector<Trouble> scene_troubles();     ///< polygons, normals, colours, transforms
std::vector<Trouble> picture_troubles();   ///< cameras, clipping
std::vector<Trouble> light_troubles();     ///< light, shadows, planes of cameras
std::vector<Trouble> library_troubles();   ///< calls of the C++ interface, limits

}  // namespace rastrum::odd
