// Expressions through muParser. A parser holds the values of its variables, so each thread takes
// one of its own from a pool. Without the library at build time the function says what to install.
#include <rastrum/terrain_light.hpp>

#include <rastrum/error.hpp>

#ifdef RASTRUM_HAS_MUPARSER
#include <muParser.h>

#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>
#endif

namespace rastrum::terrain {
#ifdef RASTRUM_HAS_MUPARSER
namespace {

struct Formula {
  double x = 0, y = 0;
  mu::Parser parser;

  explicit Formula(const std::string& text) {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.SetExpr(text);
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;
};

class Pool {
 public:
  explicit Pool(std::string text) : text_(std::move(text)) {}

  [[nodiscard]] std::unique_ptr<Formula> take() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Formula> f = std::move(free_.back());
        free_.pop_back();
        return f;
      }
    }
    return std::make_unique<Formula>(text_);
  }
  void give(std::unique_ptr<Formula> f) {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(f));
  }

 private:
  std::string text_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Formula>> free_;
};

/// Beyond float32 is infinite.
float to_float(double v) {
  constexpr double kMost = std::numeric_limits<float>::max();
  if (v > kMost) return std::numeric_limits<float>::infinity();
  if (v < -kMost) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(v);
}

}  // namespace

HeightFunction expression_function(const std::string& expression) {
  const auto pool = std::make_shared<Pool>(expression);
  try {
    std::unique_ptr<Formula> first = pool->take();
    int results = 0;
    first->parser.Eval(results);
    if (results != 1)
      throw Error(Errc::invalid_argument, "the expression '" + expression + "' is " +
                                              std::to_string(results) +
                                              " values, but a height is one");
    pool->give(std::move(first));
  } catch (const mu::Parser::exception_type& e) {
    throw Error(Errc::invalid_argument, "the expression '" + expression + "': " + e.GetMsg());
  }
  return [pool](const double* x, const double* y, std::size_t n, float* out) {
    std::unique_ptr<Formula> f = pool->take();
    for (std::size_t i = 0; i < n; ++i) {
      f->x = x[i];
      f->y = y[i];
      out[i] = to_float(f->parser.Eval());
    }
    pool->give(std::move(f));
  };
}

#else

HeightFunction expression_function(const std::string& expression) {
  throw Error(Errc::unsupported, "the expression '" + expression +
                                     "' needs muParser, which was not there when rastrum was built "
                                     "(Debian: libmuparser-dev)");
}

#endif
}  // namespace rastrum::terrain
