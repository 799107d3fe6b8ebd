#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/shapes.hpp>

namespace rastrum::test::spec_test {
namespace {

bool same(const Mesh& a, const Mesh& b) {
  return a.indices == b.indices && a.positions.size() == b.positions.size() &&
         std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)) ==
             0;
}

TEST(Spec, DefaultsAreThoseOfTheFunctions) {
  EXPECT_TRUE(same(shapes::from_spec("teapot"), shapes::teapot()));
  EXPECT_TRUE(same(shapes::from_spec("sphere"), shapes::sphere()));
  EXPECT_TRUE(same(shapes::from_spec("torus_knot"), shapes::torus_knot()));
  EXPECT_TRUE(same(shapes::from_spec("boxes"), shapes::boxes()));
  EXPECT_TRUE(same(shapes::from_spec("hairball"), shapes::hairball()));
  EXPECT_TRUE(same(shapes::from_spec("gyroid"), shapes::gyroid()));
  EXPECT_TRUE(same(shapes::from_spec("soup"), shapes::soup()));
}

TEST(Spec, ReadsEveryParameter) {
  EXPECT_TRUE(same(shapes::from_spec("teapot?n=3"), shapes::teapot(3)));
  EXPECT_TRUE(same(shapes::from_spec("sphere?segments=7&rings=5"), shapes::sphere(5, 7)));
  EXPECT_TRUE(same(shapes::from_spec("torus_knot?p=3&q=5&segments=90&sides=6&tube=0.125"),
                   shapes::torus_knot(3, 5, 90, 6, 0.125F)));
  EXPECT_TRUE(same(shapes::from_spec("boxes?count=2&fill=0.25"), shapes::boxes(2, 0.25F)));
  EXPECT_TRUE(same(shapes::from_spec("hairball?strands=9&segments=8&width=1e-2&seed=7"),
                   shapes::hairball(9, 8, 0.01F, 7)));
  EXPECT_TRUE(same(shapes::from_spec("gyroid?cells=9&periods=1.5"), shapes::gyroid(9, 1.5F)));
  EXPECT_TRUE(same(shapes::from_spec("soup?count=5&min_size=0.1&max_size=0.5&seed=123456789012"),
                   shapes::soup(5, 0.1F, 0.5F, 123456789012)));
}

TEST(Spec, CatalogueListsWhatFromSpecKnows) {
  const auto infos = shapes::catalogue();
  EXPECT_EQ(infos.size(), 7U);
  for (const shapes::ShapeInfo& info : infos) {
    EXPECT_FALSE(info.description.empty());
    // The listed parameters with their defaults are themselves a specification.
    EXPECT_TRUE(
        same(shapes::from_spec(info.name + "?" + info.parameters), shapes::from_spec(info.name)))
        << info.name;
  }
}

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Errc::invalid_argument);
    return e.what();
  }
  return "no error";
}

TEST(Spec, ErrorsNameWhatIsWrongAndWhatIsKnown) {
  const auto expect = [](const char* spec, std::initializer_list<const char*> parts) {
    const std::string message = error_of([&] { static_cast<void>(shapes::from_spec(spec)); });
    for (const char* part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << spec << " → " << message;
  };
  expect("", {"no shape ''", "teapot"});
  expect("teapod",
         {"teapod", "teapot", "sphere", "torus_knot", "boxes", "hairball", "gyroid", "soup"});
  expect("teapot?m=3", {"teapot", "'m'", "known are n"});
  expect("teapot?n", {"teapot", "n needs a value"});
  expect("teapot?n=", {"teapot", "n must be", "''"});
  expect("teapot?n=3x", {"n must be", "'3x'"});
  expect("teapot?n=99999999999", {"n must be", "'99999999999'"});
  expect("teapot?n=0", {"teapot: n must lie in [1,", "got 0"});
  expect("teapot?n=3&n=4", {"n is given twice"});
  expect("sphere?rings=1", {"sphere: rings"});
  expect("torus_knot?p=2&q=4", {"p and q", "2 and 4"});
  expect("boxes?fill=nan", {"boxes: fill", "nan"});
  expect("hairball?strands=100000000&segments=100", {"strands and segments", "32-bit"});
  expect("hairball?seed=-1", {"seed must be", "'-1'"});
  expect("soup?min_size=0.5&max_size=0.1", {"soup: min_size", "0.5"});
  expect("gyroid?periods=inf", {"gyroid: periods", "inf"});
}

}  // namespace
}  // namespace rastrum::test::spec_test
