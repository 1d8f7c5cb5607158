// Server: the HTTP door as a whole: listens, keeps its connections within their number, feeds the live feed its time, stops in order.
// In: the ports, Settings, the embedded files. Out: an open door at an address.
// Runs on one io_context with one thread (the warm one), which also runs the ports' callbacks.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>

#include "gateway/doors/http/counters.hpp"
#include "gateway/doors/http/settings.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/door.hpp"
#include "gateway/services/ports.hpp"
#include "gateway/services/services.hpp"

namespace axisgate::http {

struct TlsIdentity;

class Server final : public ServiceDoor {
public:
    /// The owners of the ports, and the services, outlive the server. Without users among the services this machine alone is let in.
    Server(boost::asio::io_context& context, const Ports& ports, Services& services, Settings settings, AssetLookup asset);
    ~Server() override;
    [[nodiscard]] std::span<const WayIn> ways_in() const override { return ways_of_clients; }
    [[nodiscard]] std::string_view name() const override { return secure() ? "https" : "http"; }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Before start(): every connection is TLS with this identity.
    void use_tls(std::shared_ptr<TlsIdentity> identity);
    [[nodiscard]] bool secure() const noexcept;
    /// Opens the door. Empty: it is open; else what is wrong and what to do.
    [[nodiscard]] std::string start() override;
    /// "127.0.0.1:8080", with the port that was really taken; empty while it is closed.
    [[nodiscard]] std::string address() const override;
    /// Takes no more connections, ends idle ones, lets requests in progress end (for at most Settings::stop_limit), closes live-feed
    /// clients with 1001; then calls `done`, from the io_context.
    void stop(std::function<void()> done) override;

    [[nodiscard]] const Counters& counters() const noexcept;

private:
    struct Parts;
    std::shared_ptr<Parts> parts_;
};

/// "ADDRESS:PORT" into an endpoint: IP addresses, `localhost`, `*` or nothing for every address. On nothing: `fault`.
[[nodiscard]] std::optional<boost::asio::ip::tcp::endpoint> parse_bind(std::string_view bind, std::string& fault);

}  // namespace axisgate::http
