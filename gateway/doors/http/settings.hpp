// The settings of the HTTP door: its address, its bounds, the hosts that may name it. The runtime fills them from the host configuration;
// they do not change while the door is open.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/registers/profiles/language.hpp"
#include "gateway/site/site.hpp"

namespace axisgate::http {

/// Bytes of an embedded file by its path in the source tree ("web/dist/index.html"); data() == nullptr if there is none.
using AssetLookup = std::function<std::string_view(std::string_view path)>;

struct Settings {
    std::string bind = "127.0.0.1:8080";  ///< ADDRESS:PORT; "[::1]:8080", "localhost:8080"; port 0: any free one
    std::string version = "0";            ///< of the program, for /about
    /// Names by which clients may call this gateway in addition to IP addresses and localhost. All other names are refused with 421 for
    /// every `bind`: a page of another site may bind its own name to this machine, and its requests would come from this machine.
    std::vector<std::string> allowed_hosts;
    MapGaps map_gaps = MapGaps::zero;  ///< [modbus] gaps: of units that the site does not name
    registers::Languages languages{};  ///< the languages of register profiles, for the list of their registers
    bool low_word_first = false;       ///< of the standard map, as in `[modbus] word_order`
    bool require_if_match = false;     ///< true: PUT /site without If-Match is refused with 428

    /// An eighth more for signed-in clients; beyond: gateway/core/places.hpp decides which connection is closed; if none may be closed,
    /// 503.
    std::size_t max_connections = 512;
    std::size_t max_header_bytes = 8 * 1024;          ///< request line and headers including the empty line; beyond: 431
    std::size_t max_stranger_bytes = 8 * 1024;        ///< body of a request without credentials, such as a sign-in; beyond: 413
    std::size_t max_body_bytes = 1024 * 1024;         ///< beyond: 413
    std::size_t max_backup_bytes = 64 * 1024 * 1024;  ///< PUT /backup only
    /// Of all answers and bodies above 64 KiB together in the gateway's memory; beyond: 503.
    std::size_t max_held_bytes = 128 * 1024 * 1024;
    std::chrono::milliseconds header_limit{10'000};  ///< from the first byte (or the connection) to the end of the headers; then 408
    std::chrono::milliseconds body_limit{30'000};    ///< for the whole body; then 408
    std::chrono::milliseconds idle_limit{60'000};    ///< between two requests of a connection; then it is closed
    std::chrono::milliseconds write_limit{30'000};   ///< without progress in writing an answer, or for one batch of the live feed; then the
                                                     ///< connection is cut
    std::chrono::milliseconds answer_limit_at_stop{200};  ///< for requests that wait for an answer when the door is closed
    std::chrono::milliseconds stop_limit{600};            ///< for all requests in progress then
    std::chrono::milliseconds linger_limit{2'000};        ///< for the client to read a last answer before the connection is cut

    std::chrono::milliseconds ping_period{20'000};    ///< of the live feed
    std::chrono::milliseconds right_period{2'000};    ///< live feed: period of the check whether its session or token is still valid
    std::chrono::milliseconds silence_limit{60'000};  ///< live feed: closed with 1008 after this time without a byte from the client
    std::size_t max_message_bytes = 64 * 1024;        ///< one message from a live-feed client; beyond: 1009
    std::size_t max_events_waiting = 4096;            ///< events that wait for one live-feed client; beyond: 1013
};

}  // namespace axisgate::http
