// Fuzz target for the input of `axisgate compare`: a recording in any form, of any family, as a whole: its reading, the directions, the
// check of the family, the play to a twin, and the report. Laws: a recording is refused with a sentence or compared; no more answers are
// equal than there are; each difference says what differs; the report is whole.
#include <boost/json/serialize.hpp>

#include "gateway/runtime/compare_input.hpp"
#include "gateway/runtime/compare_report.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 || size > 16 * 1024) return 0;
    const auto& all = fuzz::families();
    const FamilyEntry& entry = all.entries[(data[0] & 15u) % all.entries.size()];
    static constexpr const char *formats[] = {"", "candump", "hex", "trace", "pcapng", "axr", "", ""},
                                *specimens[] = {"0", "slow", "chatty", "old"};
    CompareOptions o;
    o.family = entry.family->name;
    o.file = "recording";
    o.format = formats[data[1] & 7u];
    o.specimen = specimens[data[1] >> 3 & 3u];
    o.tolerance_ms = (data[1] & 0x20u) != 0 ? 0 : 20;
    if ((data[0] & 0x80u) != 0) o.addresses.emplace_back(entry.family->factory_address);
    const std::string_view recording(reinterpret_cast<const char*>(data) + 2, size - 2);
    std::string fault;
    const auto input = comparison_input(all, o, recording, "", fault);
    fuzz::require(input.has_value() == fault.empty(), "a recording is refused with a reason, or it is compared");
    fuzz::require(fault.size() < 1000, "a reason is a sentence");
    if (!input) return 0;
    Duration last{};
    for (const auto& f : input->frames) {
        fuzz::require(f.frame.at - time_zero >= last, "instants do not step back");
        last = f.frame.at - time_zero;
    }
    const Comparison c = compare(*input);
    if (!c.fault.empty()) return 0;
    fuzz::require(c.scores.size() == 1 && c.scores.front().specimen == o.specimen, "the specimen that was asked for is tried");
    fuzz::require(c.equal <= c.answers, "no more answers are equal than there are");
    fuzz::require(c.scores.front().differences() == c.differences.size(), "each difference is counted once");
    for (const Difference& d : c.differences) {
        fuzz::require(!d.recorded.empty() || !d.twin.empty(), "a difference says what differs");
        if (d.kind == Difference::Kind::late) fuzz::require(d.reply > d.most, "a late answer is behind its range");
        if (d.kind == Difference::Kind::early) fuzz::require(d.reply < d.least, "an early answer is before its range");
    }
    fuzz::require(!comparison_text(*input, c).empty(), "the report is whole");
    fuzz::require(boost::json::serialize(comparison_json(*input, c)).size() > 100, "the report is whole");
    return 0;
}
