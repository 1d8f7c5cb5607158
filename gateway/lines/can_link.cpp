// Reads and writes the netlink messages about a CAN interface.
// Messages are not walked with the macros of the kernel's headers, because those macros trust the lengths in the message.
#include "gateway/lines/can_link.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <cerrno>
#include <cstring>

namespace axisgate {
namespace {

constexpr std::size_t aligned(std::size_t n) noexcept { return (n + 3) & ~std::size_t{3}; }

template <class T>
std::optional<T> read(std::span<const std::uint8_t> from) noexcept {
    if (from.size() < sizeof(T)) return std::nullopt;
    T t;
    std::memcpy(&t, from.data(), sizeof t);
    return t;
}

/// Calls f(type, value) for each attribute that is complete.
template <class F>
void each_attribute(std::span<const std::uint8_t> data, F&& f) {
    while (const auto head = read<rtattr>(data)) {
        if (head->rta_len < sizeof(rtattr) || head->rta_len > data.size()) return;
        f(head->rta_type & ~NLA_F_NESTED, data.subspan(sizeof(rtattr), head->rta_len - sizeof(rtattr)));
        data = data.subspan(std::min(aligned(head->rta_len), data.size()));
    }
}

std::string text_of(std::span<const std::uint8_t> value) {
    std::string s(value.begin(), value.end());
    return s.substr(0, s.find('\0'));
}

std::optional<CanState> state_of(std::uint32_t kernel) noexcept {
    switch (kernel) {
        case CAN_STATE_ERROR_ACTIVE:
            return CanState::active;
        case CAN_STATE_ERROR_WARNING:
            return CanState::warning;
        case CAN_STATE_ERROR_PASSIVE:
            return CanState::passive;
        case CAN_STATE_BUS_OFF:
            return CanState::bus_off;
        case CAN_STATE_STOPPED:
            return CanState::stopped;
        case CAN_STATE_SLEEPING:
            return CanState::sleeping;
        default:
            return std::nullopt;
    }
}

void read_can(LinkNews& n, std::span<const std::uint8_t> data) {
    each_attribute(data, [&n](int type, std::span<const std::uint8_t> value) {
        switch (type) {
            case IFLA_CAN_BITTIMING:
                if (const auto t = read<can_bittiming>(value)) n.bit_rate = t->bitrate;
                break;
            case IFLA_CAN_STATE:
                if (const auto v = read<std::uint32_t>(value)) n.state = state_of(*v);
                break;
            case IFLA_CAN_RESTART_MS:
                n.restart_ms = read<std::uint32_t>(value);
                break;
            case IFLA_CAN_BERR_COUNTER:
                if (const auto c = read<can_berr_counter>(value)) {
                    n.has_counters = true;
                    n.tx_errors = static_cast<std::uint8_t>(std::min<unsigned>(c->txerr, 255));
                    n.rx_errors = static_cast<std::uint8_t>(std::min<unsigned>(c->rxerr, 255));
                }
                break;
            default:
                break;
        }
    });
}

LinkNews read_link(bool removed, std::span<const std::uint8_t> body) {
    LinkNews n;
    n.kind = removed ? LinkNews::Kind::removed : LinkNews::Kind::link;
    const auto head = read<ifinfomsg>(body);
    if (!head) return n;
    n.index = head->ifi_index;
    n.up = (head->ifi_flags & IFF_UP) != 0;
    std::span<const std::uint8_t> can;
    each_attribute(body.subspan(aligned(sizeof(ifinfomsg))), [&](int type, std::span<const std::uint8_t> value) {
        if (type == IFLA_IFNAME) n.name = text_of(value);
        if (type != IFLA_LINKINFO) return;
        each_attribute(value, [&](int inner, std::span<const std::uint8_t> data) {
            if (inner == IFLA_INFO_KIND) n.type = text_of(data);
            if (inner == IFLA_INFO_DATA) can = data;
        });
    });
    if (n.type == "can") read_can(n, can);  // the attribute numbers have another meaning for other interface types
    return n;
}

class Request {
public:
    Request(std::uint16_t type, std::uint16_t flags, int index, std::uint32_t sequence) {
        nlmsghdr head{};
        head.nlmsg_type = type;
        head.nlmsg_flags = flags;
        head.nlmsg_seq = sequence;
        put(&head, sizeof head);
        ifinfomsg link{};
        link.ifi_family = AF_UNSPEC;
        link.ifi_index = index;
        put(&link, sizeof link);
    }
    std::size_t begin(std::uint16_t type) {
        const std::size_t at = bytes_.size();
        const rtattr head{0, type};
        put(&head, sizeof head);
        return at;
    }
    void end(std::size_t at) {
        const auto length = static_cast<std::uint16_t>(bytes_.size() - at);
        std::memcpy(bytes_.data() + at, &length, sizeof length);
        bytes_.resize(aligned(bytes_.size()));
    }
    void attribute(std::uint16_t type, const void* data, std::size_t size) {
        const std::size_t at = begin(type);
        put(data, size);
        end(at);
    }
    std::vector<std::uint8_t> done() {
        const auto length = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &length, sizeof length);
        return std::move(bytes_);
    }

private:
    void put(const void* data, std::size_t size) {
        const auto* p = static_cast<const std::uint8_t*>(data);
        bytes_.insert(bytes_.end(), p, p + size);
    }
    std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::vector<std::uint8_t> link_request(int index, std::uint32_t sequence) {
    return Request(RTM_GETLINK, NLM_F_REQUEST, index, sequence).done();
}

std::vector<std::uint8_t> restart_request(int index, std::uint32_t sequence) {
    Request r(RTM_NEWLINK, NLM_F_REQUEST | NLM_F_ACK, index, sequence);
    const std::size_t info = r.begin(IFLA_LINKINFO);
    r.attribute(IFLA_INFO_KIND, "can", 3);
    const std::size_t data = r.begin(IFLA_INFO_DATA);
    const std::uint32_t yes = 1;
    r.attribute(IFLA_CAN_RESTART, &yes, sizeof yes);
    r.end(data);
    r.end(info);
    return r.done();
}

std::vector<LinkNews> read_link_news(std::span<const std::uint8_t> datagram) {
    std::vector<LinkNews> all;
    while (const auto head = read<nlmsghdr>(datagram)) {
        if (head->nlmsg_len < sizeof(nlmsghdr) || head->nlmsg_len > datagram.size()) break;
        const auto body = datagram.subspan(sizeof(nlmsghdr), head->nlmsg_len - sizeof(nlmsghdr));
        if (head->nlmsg_type == RTM_NEWLINK || head->nlmsg_type == RTM_DELLINK) {
            if (body.size() >= sizeof(ifinfomsg)) all.push_back(read_link(head->nlmsg_type == RTM_DELLINK, body));
        } else if (head->nlmsg_type == NLMSG_ERROR) {
            if (const auto error = read<int>(body)) {
                LinkNews n;
                n.kind = LinkNews::Kind::answer;
                n.sequence = head->nlmsg_seq;
                n.error = *error > -4096 && *error <= 0 ? -*error : EPROTO;  // the kernel sends errno as a negative number; other values
                                                                             // are no error number
                all.push_back(n);
            }
        }
        datagram = datagram.subspan(std::min(aligned(head->nlmsg_len), datagram.size()));
    }
    return all;
}

}  // namespace axisgate
