#include "gateway/services/specimens.hpp"

#include <string>

#include "gateway/core/specimen.hpp"

namespace axisgate {
namespace json = boost::json;

json::object freedom_document(const Freedom& f) {
    json::object values, named;
    for (const auto& [n, meaning] : f.values)
        values[std::to_string(n)] = meaning;
    for (const auto& [name, value] : f.extremes)
        named[name] = value;
    return {{"name", f.name},
            {"unit", f.unit.empty() ? json::value(nullptr) : json::value(f.unit)},
            {"min", f.min},
            {"max", f.max},
            {"default", f.fallback},
            {"values", std::move(values)},
            {"named", std::move(named)},
            {"source", f.source},
            {"description", f.description}};
}

json::array freedoms_document(const Catalogue& page) {
    json::array out;
    for (const Freedom& f : page.freedoms())
        out.push_back(freedom_document(f));
    return out;
}

json::object specimen_document(const Catalogue& page, std::string_view specimen) {
    const FreedomValues drawn = specimen_values(page, specimen);
    json::object values;
    for (const Freedom& f : page.freedoms())  // in the order of the page
        values[f.name] = freedom(drawn, f.name, f.fallback);
    json::array words;
    for (const auto& line : specimen_in_words(page, drawn))
        words.emplace_back(line);
    return {{"family", page.family()}, {"specimen", specimen}, {"values", std::move(values)}, {"words", std::move(words)}};
}

}  // namespace axisgate
