// The JSON of a family's freedoms and of one specimen, as the program's command and the API show them. Only the catalogue is read.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <string_view>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/freedom.hpp"

namespace axisgate {

/// The members of a freedom as in the family's page, all of them present: "unit" is null where there is none, "values" and "named" are
/// objects that may be empty.
[[nodiscard]] boost::json::object freedom_document(const Freedom& f);
[[nodiscard]] boost::json::array freedoms_document(const Catalogue& page);
/// {"family", "specimen", "values": {"reply_ms": 0, ...}, "words": ["reply_ms = 200 ms: ...", ...]}; `words` has an entry for each value
/// that differs from the drive that the manual shows. `specimen` must be one (is_specimen).
[[nodiscard]] boost::json::object specimen_document(const Catalogue& page, std::string_view specimen);

}  // namespace axisgate
