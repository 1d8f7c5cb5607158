// Reads the interfaces once, when the door is opened. The serial number is derived from the hardware address, or from the host's name if
// there is none.
#include "gateway/doors/enip/host_facts.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string_view>

namespace axisgate::enip {
namespace {
std::uint32_t number_of(const sockaddr* a) { return ntohl(reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr); }

std::uint32_t hash_of(std::string_view text) {
    std::uint32_t h = 2166136261u;
    for (const char c : text)
        h = (h ^ static_cast<std::uint8_t>(c)) * 16777619u;
    return h;
}
}  // namespace

HostFacts host_facts(std::uint32_t address) {
    HostFacts f;
    char name[256] = {};
    (void)::gethostname(name, sizeof name - 1);
    f.host_name = name;
    f.serial = hash_of(f.host_name);
    f.address = address != 0 ? address : 0x7F000001;
    f.mask = 0xFF000000;
    ifaddrs* list = nullptr;
    if (::getifaddrs(&list) != 0) return f;
    const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> kept(list, ::freeifaddrs);
    std::string_view interface;
    for (const ifaddrs* i = list; i; i = i->ifa_next) {
        if (!i->ifa_addr || !i->ifa_netmask || i->ifa_addr->sa_family != AF_INET || !(i->ifa_flags & IFF_UP)) continue;
        const bool meant = address != 0 ? number_of(i->ifa_addr) == address : !(i->ifa_flags & IFF_LOOPBACK);
        if (!meant) continue;
        f.address = number_of(i->ifa_addr);
        f.mask = number_of(i->ifa_netmask);
        interface = i->ifa_name;
        break;
    }
    for (const ifaddrs* i = list; i; i = i->ifa_next) {
        if (!i->ifa_addr || i->ifa_addr->sa_family != AF_PACKET || interface != i->ifa_name) continue;
        const auto* link = reinterpret_cast<const sockaddr_ll*>(i->ifa_addr);
        if (link->sll_halen != f.mac.size()) continue;
        std::copy_n(link->sll_addr, f.mac.size(), f.mac.begin());
        const bool any = std::ranges::any_of(f.mac, [](std::uint8_t b) { return b != 0; });
        if (any) f.serial = hash_of({reinterpret_cast<const char*>(f.mac.data()), f.mac.size()});
    }
    return f;
}

}  // namespace axisgate::enip
