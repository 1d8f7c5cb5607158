// Recording file (.axr): a header, then named sections, each with its hash; the last one vouches for all. docs/handbook/recorder.md.
// In: sections. Out: bytes; and from bytes the sections, or one sentence that says what is wrong. Never gives a part of a file that is
// cut off, altered or of another version.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

inline constexpr std::uint16_t axr_version = 1;
inline constexpr std::string_view axr_magic{
    "\x89"
    "AXR\r\n\x1A\n",
    8};
inline constexpr std::size_t most_axr_bytes = std::size_t{1} << 30;

/// Names of sections, four letters each.
inline constexpr std::string_view axr_meta = "META",  ///< JSON: name, when, who, why, version, bounds, names by number
    axr_site = "SITE",                                ///< JSON: the site in force when it was frozen
    axr_inputs = "INPT",                              ///< every input since the gateway's start (FlightLog); missing: not replayable
    axr_records = "RECS",                             ///< the last stretch, inputs and outcomes (FlightLog)
    axr_capture = "CAPT",                             ///< of a capture: its columns as JSON, in the place of RECS
    axr_trends = "TRND",                              ///< of kept trends: for each axis its name and its rows, in the place of RECS
    axr_frames = "PCAP",                              ///< its frames as pcapng
    axr_end = "END ";                                 ///< SHA-256 over all that comes before it

/// Puts a file together, section by section; `finish` adds the last one.
class AxrWriter {
public:
    AxrWriter();
    void begin(std::string_view name);
    void add(std::span<const char> part);
    [[nodiscard]] std::string finish();

private:
    void close();
    std::string out_;
    std::size_t begins_ = 0;  ///< of the section that is open; 0: none
};

struct Axr {
    struct Section {
        std::string_view name;
        std::span<const char> data;
    };
    std::string fault;  ///< not empty: nothing else counts
    std::vector<Section> sections;
    [[nodiscard]] std::span<const char> section(std::string_view name) const;
    [[nodiscard]] bool has(std::string_view name) const;
};
/// Views into `bytes`.
[[nodiscard]] Axr read_axr(std::span<const char> bytes);
/// META alone, of a file's beginning that need not be all of it; empty: it is none, and `fault` says why.
[[nodiscard]] std::string_view axr_head(std::span<const char> bytes, std::string& fault);

/// Empty, or what is wrong with the name of a recording or capture: letters, digits, - _ and . , 1 to 64, not beginning with a dot.
[[nodiscard]] std::string check_recording_name(std::string_view name);

}  // namespace axisgate
