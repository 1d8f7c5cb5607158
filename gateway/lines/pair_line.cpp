// PairLine creates a pair of sockets at each attempt and gives one end away before the line comes up.
#include "gateway/lines/pair_line.hpp"

#include <fmt/core.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "gateway/lines/error_text.hpp"

namespace axisgate {

void PairLine::start() {
    if (!other_) return went_down("this gateway is in no fleet: [dds] enabled is false in the host's configuration");
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
        return went_down(fmt::format("cannot make a pair of sockets: {}", error_text(errno)));
    other_(ends[1]);
    std::string why;
    if (!attach(ends[0], true, why)) return went_down(fmt::format("cannot use a pair of sockets: {}", why));
    if (came_up("up, joined with the fleet")) begin_reading();
}

void PairLine::on_gone(int error) {
    went_down(error == 0 ? std::string("the fleet has let go of the line") : fmt::format("the fleet's end failed: {}", error_text(error)));
}

}  // namespace axisgate
