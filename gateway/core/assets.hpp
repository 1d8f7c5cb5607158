// The files that are embedded in the program: catalogues, SQL migrations, the OpenAPI description, the page. The build gathers them; at run
// time they are bytes by path ("schema/families/uim342.json"), so that the program consists of one file.
#pragma once

#include <span>
#include <string_view>

namespace axisgate {

struct Asset {
    std::string_view path;  ///< as in the source tree
    std::string_view bytes;
};

/// All of them, in no special order. (Generated.)
[[nodiscard]] std::span<const Asset> all_assets();

/// The bytes of one; an empty view with data() == nullptr if there is none.
[[nodiscard]] inline std::string_view asset(std::string_view path) {
    for (const Asset& a : all_assets()) {
        if (a.path == path) return a.bytes;
    }
    return {};
}

}  // namespace axisgate
