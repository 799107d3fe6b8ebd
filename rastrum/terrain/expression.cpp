// SPDX-License-Identifier: BSD-3-Clause
// Expressions through muParser. A parser holds the values of its variables, so each thread has its
// own.
//
// muParser only parses: its functions are a libm's, and its operators may be fused on ARM, so
// neither has the same bits everywhere.
#include <rastrum/terrain_light.hpp>

#include <rastrum/core/float_scope.hpp>
#include <rastrum/core/number_text.hpp>
#include <rastrum/core/reject.hpp>
#include <rastrum/error.hpp>

#ifdef RASTRUM_HAS_MUPARSER
#include <muParser.h>

#include <cmath>
#include <limits>
#include <memory>

#include <rastrum/core/elementary.hpp>
#include <rastrum/parallel/scratch.hpp>
#endif

namespace rastrum::terrain {
#ifdef RASTRUM_HAS_MUPARSER
namespace {

double power(double x, double y) {
  if (y == 2) return x * x;
  if (y == 3) return x * x * x;
  if (y == 4) return x * x * x * x;
  return elementary::pow(x, y);
}
// These lose digits near 0, but no more than a float32 height can spare.
double sinh(double x) {
  const double e = elementary::exp(x);
  return (e - 1 / e) / 2;
}
double cosh(double x) {
  const double e = elementary::exp(x);
  return (e + 1 / e) / 2;
}
double tanh(double x) {
  return 1 - 2 / (elementary::exp(2 * x) + 1);
}
double asinh(double x) {
  const double size = std::abs(x);
  return std::copysign(elementary::log(size + std::sqrt(size * size + 1)), x);
}
double acosh(double x) {
  return elementary::log(x + std::sqrt(x * x - 1));
}
double atanh(double x) {
  return (elementary::log1p(x) - elementary::log1p(-x)) / 2;
}

/// Replaces muParser's arithmetic. Its remaining operations add, compare or round.
void define_arithmetic(mu::Parser& parser) {
  struct Function {
    const char* name;
    double (*of)(double);
  };
  constexpr Function kFunctions[] = {{"sin", elementary::sin},
                                     {"cos", elementary::cos},
                                     {"tan", elementary::tan},
                                     {"asin", elementary::asin},
                                     {"acos", elementary::acos},
                                     {"atan", elementary::atan},
                                     {"sinh", sinh},
                                     {"cosh", cosh},
                                     {"tanh", tanh},
                                     {"asinh", asinh},
                                     {"acosh", acosh},
                                     {"atanh", atanh},
                                     {"exp", elementary::exp},
                                     {"log", elementary::log},
                                     {"ln", elementary::log},
                                     {"log2", elementary::log2},
                                     {"log10", elementary::log10}};
  for (const Function& f : kFunctions) parser.DefineFun(f.name, f.of);
  parser.DefineFun("atan2", elementary::atan2);

  struct Operator {
    const char* name;
    double (*of)(double, double);
    unsigned precedence;
  };
  const Operator operators[] = {
      {"+", [](double a, double b) { return a + b; }, mu::prADD_SUB},
      {"-", [](double a, double b) { return a - b; }, mu::prADD_SUB},
      {"*", [](double a, double b) { return a * b; }, mu::prMUL_DIV},
      {"/", [](double a, double b) { return a / b; }, mu::prMUL_DIV},
      {"<", [](double a, double b) { return a < b ? 1.0 : 0.0; }, mu::prCMP},
      {">", [](double a, double b) { return a > b ? 1.0 : 0.0; }, mu::prCMP},
      {"<=", [](double a, double b) { return a <= b ? 1.0 : 0.0; }, mu::prCMP},
      {">=", [](double a, double b) { return a >= b ? 1.0 : 0.0; }, mu::prCMP},
      {"==", [](double a, double b) { return a == b ? 1.0 : 0.0; }, mu::prCMP},
      {"!=", [](double a, double b) { return a != b ? 1.0 : 0.0; }, mu::prCMP},
      {"&&", [](double a, double b) { return a != 0 && b != 0 ? 1.0 : 0.0; }, mu::prLAND},
      {"||", [](double a, double b) { return a != 0 || b != 0 ? 1.0 : 0.0; }, mu::prLOR}};
  parser.EnableBuiltInOprt(false);
  for (const Operator& o : operators)
    parser.DefineOprt(o.name, o.of, o.precedence, mu::oaLEFT, true);
  parser.DefineOprt("^", power, mu::prPOW, mu::oaRIGHT, true);
}

struct Formula {
  double x = 0, y = 0;
  mu::Parser parser;

  explicit Formula(const std::string& text) {
    define_arithmetic(parser);
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.SetExpr(text);
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;
};

float to_float(double v) {
  constexpr double kMost = std::numeric_limits<float>::max();
  if (v > kMost) return std::numeric_limits<float>::infinity();
  if (v < -kMost) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(v);
}

}  // namespace

HeightFunction expression_function(const std::string& expression) {
  const FloatScope floats;
  const auto formulas = std::make_shared<parallel::ScratchPool<Formula>>(
      [expression] { return Formula(expression); });
  try {
    int results = 0;
    formulas->local().parser.Eval(results);
    if (results != 1)
      reject("the expression '", expression, "' is ", results, " values, but a height is one");
  } catch (const mu::Parser::exception_type& e) {
    reject("the expression '", expression, "': ", e.GetMsg());
  }
  return [formulas](const double* x, const double* y, std::size_t n, float* out) {
    Formula& f = formulas->local();
    for (std::size_t i = 0; i < n; ++i) {
      f.x = x[i];
      f.y = y[i];
      out[i] = to_float(f.parser.Eval());
    }
  };
}

#else

HeightFunction expression_function(const std::string& expression) {
  const FloatScope floats;
  throw Error(
      Errc::unsupported,
      text_of("the expression '", expression,
              "' needs muParser, but this rastrum was built without it (Debian: libmuparser-dev)"));
}

#endif
}  // namespace rastrum::terrain
