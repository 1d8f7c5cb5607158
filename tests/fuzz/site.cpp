// Fuzz target for foreign JSON and the site document, as `axisgate check`, `--site` and PUT /api/v1/site read it. Laws: a site or a fault,
// never both; faults have a place and a remedy; a written site is read as the same.
#include "gateway/site/site.hpp"
#include "gateway/core/json_read.hpp"

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cmath>

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

namespace {
/// The library makes NaN of 0e999; it counts as 0.
boost::json::value with_numbers(boost::json::value v) {
    if (v.is_double() && std::isnan(v.get_double())) return 0.0;
    if (auto* a = v.if_array())
        for (auto& item : *a)
            item = with_numbers(std::move(item));
    if (auto* o = v.if_object())
        for (auto& member : *o)
            member.value() = with_numbers(std::move(member.value()));
    return v;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    boost::system::error_code ec;
    const auto plain = boost::json::parse(boost::json::string_view(text.data(), text.size()), ec);
    JsonFault unread;
    const auto read = read_json(text, unread);
    fuzz::require(read.has_value() || !unread.text.empty(), "a value, or a fault");
    fuzz::require(!read.has_value() || (!ec && *read == with_numbers(plain)), "what is read is what the library reads");
    fuzz::require(read.has_value() || ec || unread.twice, "JSON is refused for a member that stands twice alone");
    if (!read) return 0;
    const auto& document = *read;
    std::vector<SiteFault> faults;
    const auto site = parse_site(document, fuzz::families(), faults);
    fuzz::require(site.has_value() == faults.empty(), "a site, or a fault");
    std::size_t lines = 1;
    for (const char c : text)
        lines += c == '\n';
    for (const auto& f : faults) {
        fuzz::require(f.pointer.empty() || f.pointer.front() == '/', "a fault has a JSON pointer");
        fuzz::require(!f.text.empty() && !f.remedy.empty(), "a fault has a text and a remedy");
        const auto line = line_of_pointer(text, f.pointer);
        fuzz::require(line >= 1 && line <= lines, "a fault is on a line of the document");
    }
    if (!site) return 0;
    const auto written = to_json(*site);
    std::vector<SiteFault> again_faults;
    const auto again = parse_site(written, fuzz::families(), again_faults);
    fuzz::require(again.has_value(), "what was written can be read");
    fuzz::require(to_json(*again) == written, "what was written reads back the same");
    fuzz::require(differences(*site, *again).empty(), "a site does not differ from itself");
    fuzz::require(mapping_revision(*site) == mapping_revision(*again), "the revision is a function of the site");
    return 0;
}
