#include <rastrum/scene/shapes/require.hpp>

#include <sstream>
#include <string>

#include <rastrum/error.hpp>

namespace rastrum::shapes {

void require_range(std::string_view shape, std::string_view parameter, double value, double low,
                   double high) {
  if (value >= low && value <= high) return;
  std::ostringstream message;
  message << shape << ": " << parameter << " must lie in [" << low << ", " << high << "], got "
          << value;
  throw Error(Errc::invalid_argument, message.str());
}

void require_size(std::string_view shape, std::string_view parameters, double vertices) {
  if (vertices < 4294967296.0) return;
  std::ostringstream message;
  message << shape << ": " << parameters << " ask for " << vertices
          << " vertices, more than 32-bit indices can number";
  throw Error(Errc::invalid_argument, message.str());
}

}  // namespace rastrum::shapes
