#include "numbered.hpp"

#include "arguments.hpp"

namespace rastrum::cli {

NumberedName::NumberedName(std::string_view option, std::string_view pattern) {
  const auto refuse = [&] {
    throw UsageError(option,
                     "expected a name with one %d or %04d in it (%% for a percent sign), "
                     "got '" +
                         std::string(pattern) + "'");
  };
  constexpr std::size_t kWidest = 20;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& part = has_number_ ? after_ : before_;
    if (pattern[i] != '%') {
      part += pattern[i];
      continue;
    }
    if (++i < pattern.size() && pattern[i] == '%') {
      part += '%';
      continue;
    }
    if (has_number_) refuse();
    has_number_ = true;
    zeros_ = i < pattern.size() && pattern[i] == '0';
    for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9' && width_ <= kWidest; ++i)
      width_ = width_ * 10 + static_cast<std::size_t>(pattern[i] - '0');
    if (i >= pattern.size() || pattern[i] != 'd' || width_ > kWidest) refuse();
  }
}

std::string NumberedName::at(std::size_t number) const {
  if (!has_number_) return before_;
  std::string digits = std::to_string(number);
  if (digits.size() < width_) digits.insert(0, width_ - digits.size(), zeros_ ? '0' : ' ');
  return before_ + digits + after_;
}

}  // namespace rastrum::cli
