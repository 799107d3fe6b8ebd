// The names of --transparency, and the picture of --show-errors.
#pragma once

#include <string>
#include <vector>

#include <rastrum/frame.hpp>
#include <rastrum/image.hpp>

namespace rastrum::cli {

/// The method of a name, or filter:K with K from 1 to 64, into `options`. Throws UsageError that
/// lists them.
void parse_transparency(const std::string& text, TransparencyOptions& options);
/// The names that parse_transparency knows.
[[nodiscard]] std::string transparency_list();
/// The same one by one, with the filter as `now` has it, else of 3.
[[nodiscard]] std::vector<std::string> transparency_names(const TransparencyOptions& now);
/// The one that parse_transparency reads as these options.
[[nodiscard]] std::string transparency_name(const TransparencyOptions& options);
/// K of filter:K; 0 for other methods.
[[nodiscard]] int filter_of(const TransparencyOptions& options);

/// From the CLI's text after --alpha-threshold; empty: paper 4's 1 − 1/128. Throws UsageError.
[[nodiscard]] float parse_alpha_threshold(const std::string& text);

struct ErrorPicture {
  Image<Rgba8> image;
  std::uint64_t wrong = 0;  ///< pixels
};

/// Red where `errors` is not 0, else the picture over black as a dim grey, so that one sees where
/// the errors are.
[[nodiscard]] ErrorPicture make_error_picture(ImageView<const Rgba8> color8,
                                              ImageView<const std::uint8_t> errors);

}  // namespace rastrum::cli
