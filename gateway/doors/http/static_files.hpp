// Static files: the page, from inside the program.
// In: a path and the embedded files. Out: the file with its entity tag, the page itself for the page's own routes, or 404.
// Never reads the disk, so no path can lead out of what was built in.
#pragma once

#include <string_view>

#include "gateway/doors/http/message.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/text.hpp"

namespace axisgate::http {

/// Files are looked up under web/dist/. A path that is no file, and not of the interface or of the page's own files, is an address of the
/// page for whoever names text/html in Accept: index.html.
[[nodiscard]] Response static_file(const AssetLookup& asset, const Target& target, const Headers& headers);

/// Media type by the name's ending; application/octet-stream for unknown ones.
[[nodiscard]] std::string_view media_for(std::string_view path) noexcept;

}  // namespace axisgate::http
