// From the command line and a recording of any form to the input of a comparison. A recording that is cut, has no times or directions, or
// is of another family is refused with a sentence.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gateway/engine/comparison.hpp"
#include "gateway/runtime/commands.hpp"

namespace axisgate {

/// `bytes` is the recording, `state` the content of options.state_file (empty: factory state). On failure `fault` has the reason and the
/// remedy.
[[nodiscard]] std::optional<ComparisonInput> comparison_input(const Families& families, const CompareOptions& options,
                                                              std::string_view bytes, std::string_view state, std::string& fault);

}  // namespace axisgate
