// File names with a number in them, as in frame_%04d.png.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rastrum::cli {

/// A name with one %d, %3d or %04d in it (%% is a percent sign), or without any.
class NumberedName {
 public:
  /// Throws UsageError naming `option` for any other use of the percent sign.
  NumberedName(std::string_view option, std::string_view pattern);
  [[nodiscard]] bool has_number() const { return has_number_; }
  [[nodiscard]] std::string at(std::size_t number) const;

 private:
  std::string before_, after_;
  bool has_number_ = false, zeros_ = false;
  std::size_t width_ = 0;
};

}  // namespace rastrum::cli
