// Recording file (.axr): a header, then named sections with a hash each; the last section has the hash of all. See
// docs/handbook/recorder.md. No part of a file that is truncated, altered or of another version is used.
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
inline constexpr std::string_view axr_meta = "META",  ///< JSON: name, time, client, reason, version, bounds, names by number
    axr_site = "SITE",                                ///< JSON: the site in force when it was written
    axr_descriptions = "DESC",                        ///< JSON: makers' descriptions that its drives name, with their texts
    axr_inputs = "INPT",                              ///< every input since the gateway's start (FlightLog); missing: not replayable
    axr_records = "RECS",                             ///< the last period, inputs and outcomes (FlightLog)
    axr_capture = "CAPT",                             ///< of a capture: its columns as JSON, instead of RECS
    axr_trends = "TRND",                              ///< of stored trends: for each axis its name and its rows, instead of RECS
    axr_frames = "PCAP",                              ///< its frames as pcapng
    axr_end = "END ";                                 ///< SHA-256 of everything before it

/// Composes a file, section by section; `finish` adds the last one.
class AxrWriter {
public:
    AxrWriter();
    void begin(std::string_view name);
    void add(std::span<const char> part);
    [[nodiscard]] std::string finish();

private:
    void close();
    std::string out_;
    std::size_t begins_ = 0;  ///< of the open section; 0: none
};

struct Axr {
    struct Section {
        std::string_view name;
        std::span<const char> data;
    };
    std::string fault;  ///< if not empty, the other members have no meaning
    std::vector<Section> sections;
    [[nodiscard]] std::span<const char> section(std::string_view name) const;
    [[nodiscard]] bool has(std::string_view name) const;
};
/// Views into `bytes`.
[[nodiscard]] Axr read_axr(std::span<const char> bytes);
/// Only META, from the beginning of a file, which need not be complete; if empty, `fault` has the reason.
[[nodiscard]] std::string_view axr_head(std::span<const char> bytes, std::string& fault);

/// Empty, or the fault in the name of a recording or capture: letters, digits, - _ and . , 1 to 64, not beginning with a dot.
[[nodiscard]] std::string check_recording_name(std::string_view name);

}  // namespace axisgate
