#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/odd/trouble.hpp"

namespace rastrum::odd {

void PrintTo(const Trouble& trouble, std::ostream* out) {
  *out << trouble.input << "; right: " << trouble.right;
}

namespace {

std::vector<Trouble> all_troubles() {
  std::vector<Trouble> all;
  for (const auto& table :
       {fault_troubles(), file_troubles(), document_troubles(), scene_troubles(),
        picture_troubles(), light_troubles(), library_troubles()}) {
    all.insert(all.end(), table.begin(), table.end());
  }
  return all;
}

class Odd : public testing::TestWithParam<Trouble> {};

TEST_P(Odd, IsDrawnRight) {
  GetParam().check();
}

INSTANTIATE_TEST_SUITE_P(Troubles, Odd, testing::ValuesIn(all_troubles()),
                         [](const auto& row) { return std::string{row.param.name}; });

}  // namespace
}  // namespace rastrum::odd
