// Lists the host ports as Linux reports them: network devices of the type CAN, and terminals with a device behind them.
// A serial port that the kernel lists without hardware (type 0) is left out; consoles and pseudo-terminals have no device. Links are read
// for their names only and never followed out of these folders. Nothing here throws.
#include "gateway/lines/host_ports.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <system_error>

namespace axisgate {
namespace {
namespace fs = std::filesystem;
constexpr std::string_view arphrd_can = "280";  // linux/if_arp.h
constexpr unsigned iff_up = 1;                  // linux/if.h
constexpr int most_parents = 6;                 // levels from a port up to the USB device that it belongs to
constexpr std::size_t longest = 128;            // maximum length of a text read from the system

/// The first line of a small file; empty if the file cannot be read.
std::string line_of(const fs::path& file) {
    std::ifstream in(file);
    std::string s;
    std::getline(in, s);
    s.resize(std::min(s.size(), longest));
    while (!s.empty() && (s.back() == ' ' || s.back() == '\r'))
        s.pop_back();
    // The device chooses its own name, so characters outside printable ASCII are removed.
    std::erase_if(s, [](unsigned char c) { return c < 0x20 || c > 0x7E; });
    return s;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> out;
    std::error_code ec;
    for (fs::directory_iterator it(folder, ec), end; !ec && it != end && out.size() < 4 * most_host_ports; it.increment(ec))
        out.push_back(it->path());
    std::ranges::sort(out);
    return out;
}

std::string driver_of(const fs::path& device) {
    std::error_code ec;
    const auto driver = fs::read_symlink(device / "driver", ec);
    return ec ? std::string() : driver.filename().string();
}

/// The name of the USB device that the port belongs to ("FTDI FT232R USB UART"), otherwise the name of its driver.
std::string text_of(const fs::path& device) {
    std::error_code ec;
    fs::path at = fs::canonical(device, ec);
    for (int i = 0; !ec && i < most_parents && at.has_relative_path(); ++i, at = at.parent_path()) {
        const std::string product = line_of(at / "product");
        if (product.empty()) continue;
        const std::string maker = line_of(at / "manufacturer");
        return maker.empty() || product.starts_with(maker) ? product : maker + " " + product;
    }
    return driver_of(device);
}
}  // namespace

std::vector<SystemPort> host_ports(const fs::path& root) {
    std::vector<SystemPort> out;
    std::error_code ec;
    for (const auto& net : entries_of(root / "sys/class/net")) {
        if (line_of(net / "type") != arphrd_can) continue;
        const std::string flags = line_of(net / "flags");
        const bool up = (std::strtoul(flags.c_str(), nullptr, 0) & iff_up) != 0;
        const bool wired = fs::exists(net / "device", ec);
        out.push_back({SystemPort::Kind::can, net.filename().string(), "", wired ? text_of(net / "device") : "virtual", up});
    }
    std::map<std::string, std::string> lasting;  // persistent names, by the name of the device
    for (const auto& link : entries_of(root / "dev/serial/by-id")) {
        const auto target = fs::read_symlink(link, ec);
        if (!ec) lasting.emplace(target.filename().string(), "/dev/serial/by-id/" + link.filename().string());
    }
    for (const auto& tty : entries_of(root / "sys/class/tty")) {
        if (!fs::exists(tty / "device", ec) || line_of(tty / "type") == "0") continue;
        const std::string name = tty.filename().string();
        const auto known = lasting.find(name);
        out.push_back(
            {SystemPort::Kind::serial, name, known == lasting.end() ? "/dev/" + name : known->second, text_of(tty / "device"), true});
    }
    if (out.size() > most_host_ports) out.resize(most_host_ports);
    return out;
}

}  // namespace axisgate
