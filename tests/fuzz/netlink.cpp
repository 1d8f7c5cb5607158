// Fuzz target for the kernel's messages about network interfaces, as datagrams of an rtnetlink socket. Laws: no length field is trusted,
// truncated parts are left out, a datagram gives no more messages than it has headers, and our own requests are no news.
#include "gateway/lines/can_link.hpp"

#include <cstring>

#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;

namespace {
constexpr std::size_t header_size = 16;

void read(std::span<const std::uint8_t> datagram) {
    const auto news = read_link_news(datagram);
    require(news.size() <= datagram.size() / header_size, "a message has a header");
    for (const LinkNews& n : news) {
        require(n.name.size() <= datagram.size() && n.type.size() <= datagram.size(), "a text is part of the datagram");
        require(n.name.find('\0') == std::string::npos && n.type.find('\0') == std::string::npos, "a text ends at its 0");
        require(n.kind == LinkNews::Kind::answer || (n.sequence == 0 && n.error == 0) || n.sequence != 0, "only an answer answers");
    }
    // A truncated datagram never gives more messages.
    for (std::size_t n = 0; n < datagram.size(); n += 1 + datagram.size() / 16)
        require(read_link_news(datagram.first(n)).size() <= news.size(), "a part says no more than the whole");
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 4096) return 0;
    read({data, size});
    // The same bytes as the body of messages about a link (16 new, 17 removed), an answer (2), and one of another kind.
    static constexpr std::uint16_t types[] = {16, 17, 2, 24};
    std::vector<std::uint8_t> whole(header_size);
    const auto length = static_cast<std::uint32_t>(header_size + size - 1);
    const std::uint16_t type = types[data[0] % 4];
    std::memcpy(whole.data(), &length, sizeof length);
    std::memcpy(whole.data() + 4, &type, sizeof type);
    whole.insert(whole.end(), data + 1, data + size);
    read(whole);
    for (const auto& request : {link_request(data[1], data[2]), restart_request(data[1], data[2])}) {
        require(request.size() >= header_size, "a request is a message");
        (void)read_link_news(request);
    }
    return 0;
}
