// The page from inside the program: a file with its entity tag, the page itself for the page's own routes, or 404. The disk is not read, so
// no path can lead outside.
#pragma once

#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {

/// Files are looked up under web/dist/. A path that is neither a file, nor of the API, nor of the page's own files, is an address of the
/// page for clients with text/html in Accept: index.html.
[[nodiscard]] Response static_file(const AssetLookup& asset, const Target& target, const Headers& headers);

/// Media type by the name's ending; application/octet-stream for unknown ones.
[[nodiscard]] std::string_view media_for(std::string_view path) noexcept;

}  // namespace axisgate::http
