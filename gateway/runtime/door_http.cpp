// The descriptor of the HTTP door: its keys, checks and warnings.
#include "gateway/runtime/door_http.hpp"

#include <fmt/core.h>
#include <sys/socket.h>

#include <algorithm>

#include "gateway/core/assets.hpp"
#include "gateway/doors/http/hosts.hpp"
#include "gateway/doors/http/server.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/late_doors.hpp"
#include "gateway/runtime/tls_files.hpp"
#include "gateway/runtime/warm_ports.hpp"

namespace axisgate {
namespace {
constexpr setting::Key http_keys[] = {
    {"http", "bind", [](Config& c, const std::string& s) { return setting::address(c.of<HttpSettings>().bind, s); }},
    {"http", "tls_cert", [](Config& c, const std::string& s) { return setting::any_text(c.of<HttpSettings>().tls_cert, s); }},
    {"http", "tls_key", [](Config& c, const std::string& s) { return setting::any_text(c.of<HttpSettings>().tls_key, s); }},
    {"http", "tls",
     [](Config& c, const std::string& s) -> setting::Unfit {
         if (s != "off" && s != "self_signed") return "write off or self_signed; certificates of your own are tls_cert and tls_key";
         c.of<HttpSettings>().tls_self_signed = s == "self_signed";
         return {};
     }},
    {"http", "allowed_hosts",
     [](Config& config, const std::string& s) -> setting::Unfit {
         auto& c = config.of<HttpSettings>();
         c.allowed_hosts = setting::list_of(s);
         const auto is_name = [](const std::string& one) {
             return http::host_is_written_right(one) && (one.ends_with(']') || one.find(':') == std::string::npos);
         };
         if (std::ranges::all_of(c.allowed_hosts, is_name)) return {};
         return "write names without scheme, port and path, such as [\"axisgate.example\"]";
     },
     setting::Written::as_list},
    {"limits", "http_connections",
     [](Config& c, const std::string& s) { return setting::whole_number(c.of<HttpSettings>().max_connections, s, 1, 8192); },
     setting::Written::as_number},
};

class RunningHttp final : public RunningDoor {
public:
    RunningHttp(std::unique_ptr<http::Server> server, std::string bind) : bind_(std::move(bind)), server_(std::move(server)) {}
    [[nodiscard]] std::string name() const override { return std::string(server_->name()); }
    [[nodiscard]] std::string open() override { return server_->start(); }
    [[nodiscard]] bool is_late() const override { return address_is_late(bind_) || address_is_taken(bind_, SOCK_STREAM); }
    [[nodiscard]] std::string address() const override { return server_->address(); }
    [[nodiscard]] std::string page() const override {
        return server_->address().empty() ? std::string() : fmt::format("{}://{}/", server_->name(), server_->address());
    }
    void stop(std::function<void()> done) override { server_->stop(std::move(done)); }

private:
    std::string bind_;
    std::unique_ptr<http::Server> server_;
};

std::unique_ptr<RunningDoor> make_http_door(const DoorHouse& house, std::vector<ConfigFault>& faults) {
    const auto& c = house.config.of<HttpSettings>();
    http::Settings hs;
    hs.version = AXISGATE_VERSION;
    hs.bind = c.bind;
    hs.map_gaps = house.config.map_gaps;
    hs.languages = house.languages;
    hs.low_word_first = house.config.low_word_first;
    hs.allowed_hosts = c.allowed_hosts;
    hs.max_connections = static_cast<std::size_t>(c.max_connections);
    auto server = std::make_unique<http::Server>(house.service, house.ports.all(), house.services, hs,
                                                 [](std::string_view path) { return asset(path); });
    const auto identity = open_tls(house.config, unix_now_ns() / 1'000'000'000, faults);
    if (!faults.empty()) return nullptr;  // plain text must not be used if the configuration requests TLS
    server->use_tls(identity);
    return std::make_unique<RunningHttp>(std::move(server), c.bind);
}

void check_http_door(const Config& config, const KeyPlace& place, std::vector<ConfigFault>& faults) {
    const auto& c = config.of<HttpSettings>();
    const std::string file = place("", "");
    if (c.tls_cert.empty() != c.tls_key.empty())
        faults.push_back({file, "http.tls_cert and http.tls_key go together", "give both or none"});
    if (c.tls_self_signed && !c.tls_cert.empty())
        faults.push_back({file, "http.tls = self_signed and http.tls_cert are both there", "leave one of them out"});
}

void warn_http_door(const Config& config, std::vector<ConfigFault>& out) {
    const auto& c = config.of<HttpSettings>();
    if (c.bind.empty() || http::host_is_loopback(c.bind)) return;
    if (c.allowed_hosts.empty())
        out.push_back(
            {"http.allowed_hosts",
             fmt::format("the HTTP door listens beyond this machine ({}) and no name is allowed: clients reach it by its IP addresses "
                         "alone, names get 421",
                         c.bind),
             "write the names that clients use, such as allowed_hosts = [\"axisgate.example\"]; nothing to do if they use addresses",
             true});
    if (!c.tls_cert.empty() || c.tls_self_signed) return;
    out.push_back(
        {"http.tls_cert",
         fmt::format("the HTTP door listens beyond this machine ({}) without TLS: passwords and tokens cross the network in plain text",
                     c.bind),
         "name a certificate with [http] tls_cert and tls_key, or set tls = \"self_signed\", or listen on 127.0.0.1 behind a proxy that "
         "speaks TLS",
         true});
    if (config.users_local_role != "none")
        out.push_back({"users.local_role",
                       fmt::format("who reaches HTTP by this machine, as through a proxy or a forwarded port, is {} without a sign-in",
                                   config.users_local_role),
                       "set [users] local_role = \"none\"", true});
}
}  // namespace

const DoorDescriptor http_door{
    .name = "http",
    .words = &http::door_words,
    .settings = http_keys,
    .wanted = [](const Config& config) { return !config.of<HttpSettings>().bind.empty(); },
    .make = make_http_door,
    .clients = {
        .key = "[limits] http_connections",
        .most =
            [](const Config& config) {
                const auto& c = config.of<HttpSettings>();
                return c.bind.empty() ? 0 : static_cast<std::uint64_t>(c.max_connections);
            },
        .lessen = [](Config& config, std::uint64_t most) { config.of<HttpSettings>().max_connections = static_cast<std::int64_t>(most); }},
    .check = check_http_door,
    .warn = warn_http_door,
    .check_files = check_tls,
    .shows_page = true,
};

}  // namespace axisgate
