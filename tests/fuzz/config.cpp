// Fuzz target for the host's configuration: TOML file, environment, --set. Laws: faults have place, text and remedy; numbers are in their
// ranges for any input.
#include "gateway/runtime/config.hpp"
#include "gateway/runtime/door_dds.hpp"
#include "gateway/runtime/door_http.hpp"
#include "gateway/runtime/door_modbus.hpp"

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 64 * 1024) return 0;
    // Split at byte 1, which occurs in none of the three parts, so that the fuzzer's inputs stay readable.
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    const auto take = [&rest] {
        const auto end = std::min(rest.find('\x01'), rest.size());
        const auto part = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        return std::string(part);
    };
    ConfigSources sources;
    sources.file_name = "axisgate.toml";
    sources.file_text = take();
    while (!rest.empty()) {
        auto part = take();
        (part.starts_with("AXISGATE_") ? sources.environment : sources.overrides).push_back(std::move(part));
    }
    std::vector<ConfigFault> faults;
    const Config c = read_config(sources, faults);
    for (const auto& f : faults)
        fuzz::require(!f.place.empty() && !f.text.empty() && !f.remedy.empty(), "a fault has place, text and remedy");
    fuzz::require(c.of<ModbusSettings>().idle_timeout_s >= 1 && c.of<ModbusSettings>().idle_timeout_s <= 86400,
                  "idle_timeout_s is in its range");
    fuzz::require(c.of<ModbusSettings>().max_connections >= 1 && c.of<ModbusSettings>().max_connections <= 8192,
                  "max_connections is in its range");
    fuzz::require(c.of<DdsSettings>().domain >= 0 && c.of<DdsSettings>().domain <= 232, "domain is in its range");
    fuzz::require(c.spin_us >= 0 && c.spin_us <= 1000, "spin_us is in its range");
    fuzz::require(c.trace_frames >= 64 && c.trace_frames <= 1'000'000, "trace_frames is in its range");
    fuzz::require(c.of<HttpSettings>().bind.empty() || parse_host_port(c.of<HttpSettings>().bind), "http.bind is an address");
    fuzz::require(c.of<ModbusSettings>().bind.empty() || parse_host_port(c.of<ModbusSettings>().bind), "modbus.bind is an address");
    return 0;
}
