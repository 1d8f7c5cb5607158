// Creates the line for each scheme of a URI. Nothing is opened here.
#include "gateway/lines/make_line.hpp"

#include "gateway/lines/pty_line.hpp"
#include "gateway/lines/serial_line.hpp"
#include "gateway/lines/tcp_line.hpp"
#include "gateway/lines/tcp_listen_line.hpp"
#include "gateway/lines/udp_line.hpp"

namespace axisgate {
namespace {

/// Stands in for a line that cannot be created; it stays down and reports the reason.
class NoLine final : public RealLine {
public:
    NoLine(const LineBase& base, std::string why) : RealLine(base), why_(std::move(why)) {}
    ~NoLine() override { close(); }

private:
    void start() override { went_down(why_); }
    void stop() override {}
    void flush() override {}
    std::string why_;
};

}  // namespace

std::unique_ptr<Line> make_line(const LineUri& uri, const LineBase& base, const CanLineOptions& can, const PtyPlaces& ptys,
                                const PairEnd& fleet) {
    switch (uri.kind) {
        case LineUri::Kind::can:
            return std::make_unique<CanLine>(base, uri.interface, can);
        case LineUri::Kind::serial:
            return std::make_unique<SerialLine>(base, uri.path, uri.serial);
        case LineUri::Kind::tcp:
            return std::make_unique<TcpLine>(base, uri.host, uri.port);
        case LineUri::Kind::tcp_listen:
            return std::make_unique<TcpListenLine>(base, uri.host, uri.port);
        case LineUri::Kind::udp:
            return std::make_unique<UdpLine>(base, uri.host, uri.port, UdpLine::Role::connects);
        case LineUri::Kind::udp_listen:
            return std::make_unique<UdpLine>(base, uri.host, uri.port, UdpLine::Role::listens);
        case LineUri::Kind::pty:
            return std::make_unique<PtyLine>(base, uri.path, uri.serial.baud, uri.serial.format, ptys);
        case LineUri::Kind::dds:
            return std::make_unique<PairLine>(base, fleet);
        case LineUri::Kind::twin:
            break;
    }
    return std::make_unique<NoLine>(base, "a twin line has no real side");
}

std::unique_ptr<Line> make_real_line(std::string_view uri, const LineSetup& setup, boost::asio::io_context& io,
                                     std::string_view default_format, const PtyPlaces& ptys, Duration stale_after, const PairEnd& fleet,
                                     const Clock& clock) {
    const LineBase base{io, clock, {}, stale_after};
    const LineUriResult parsed = parse_line_uri(uri, setup.bit_rate == 0 ? 9600 : setup.bit_rate, default_format);
    if (!parsed.good()) return std::make_unique<NoLine>(base, parsed.fault);
    CanLineOptions can;
    can.bit_rate = setup.bit_rate;
    return make_line(parsed.uri, base, can, ptys, fleet);
}

}  // namespace axisgate
