// Server is the HTTP door: it listens, limits the number of connections, drives the live feed and stops in order. It runs on one io_context
// with one thread (the warm one), which also runs the callbacks of the ports.
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
    /// The owners of the ports, and the services, must outlive the server. Without users among the services, only this computer is
    /// admitted.
    Server(boost::asio::io_context& context, const Ports& ports, Services& services, Settings settings, AssetLookup asset);
    ~Server() override;
    [[nodiscard]] std::span<const WayIn> ways_in() const override { return ways_of_clients; }
    [[nodiscard]] std::string_view name() const override { return secure() ? "https" : "http"; }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Before start(): all connections use TLS with this identity.
    void use_tls(std::shared_ptr<TlsIdentity> identity);
    [[nodiscard]] bool secure() const noexcept;
    /// Opens the door. Empty: it is open; otherwise the fault and the remedy.
    [[nodiscard]] std::string start() override;
    /// "127.0.0.1:8080", with the actual port; empty while it is closed.
    [[nodiscard]] std::string address() const override;
    /// Accepts no more connections, closes idle ones, completes requests in progress (within Settings::stop_limit), closes clients of the
    /// live feed with 1001; then calls `done` from the io_context.
    void stop(std::function<void()> done) override;

    [[nodiscard]] const Counters& counters() const noexcept;

private:
    struct Parts;
    std::shared_ptr<Parts> parts_;
};

/// "ADDRESS:PORT" as an endpoint: IP addresses, `localhost`, `*` or nothing for every address. Empty with `fault` if it is invalid.
[[nodiscard]] std::optional<boost::asio::ip::tcp::endpoint> parse_bind(std::string_view bind, std::string& fault);

}  // namespace axisgate::http
