// Fuzz target: a request through the router with a fake gateway, a WebSocket client's bytes through the codec, and a live-feed request
// through the hub. Every answer must be complete, with valid JSON if it is declared as JSON. Form of the input: the first byte selects the
// target; requests are a line with method and target, lines "Name: value" up to an empty line, and the body.
#include <boost/json/parse.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "gateway/doors/http/router.hpp"
#include "gateway/doors/http/stream_hub.hpp"
#include "gateway/doors/http/websocket_codec.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace {
using namespace axisgate;
using namespace axisgate::http;

void check(bool good) {
    if (!good) std::abort();
}

void check_response(const Response& r) {
    check(r.status >= 101 && r.status <= 599);
    const auto type = r.headers.get("Content-Type");
    if (type == "application/json" || type == "application/problem+json") {
        boost::system::error_code ec;
        (void)boost::json::parse(r.body, ec);
        check(!ec);
    }
    if (r.status >= 400) check(type == "application/problem+json");
}

std::string_view line_of(std::string_view& text) {
    const auto end = text.find('\n');
    const auto line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
}

void feed_request(std::string_view text) {
    test::FakeGateway gateway;
    gateway.at_once = [](const Command& c) {
        Result r;
        r.outcome = std::holds_alternative<Move>(c.body) ? Outcome::refused : Outcome::done;
        r.reason = std::holds_alternative<Move>(c.body) ? Reason::wrong_state : Reason::none;
        r.text = "\xFF text";
        if (const auto* m = std::get_if<Move>(&c.body)) check(m->target < (1LL << 53) && m->target > -(1LL << 53));
        return r;
    };
    gateway.hands[gateway.drive("feeder")] = {{"stall", false, true, "held"}};
    Settings settings;
    const auto recipes = std::make_shared<RecipeService>(gateway, [] { return time_zero; });
    const auto alarms = std::make_shared<AlarmService>(gateway, [] { return time_zero; });
    const Router router{Context{gateway,
                                settings,
                                [](std::string_view) { return std::string_view(); },
                                {},
                                std::make_shared<ChangeQueue>(),
                                recipes,
                                std::make_shared<AxisJobs>(),
                                nullptr,
                                alarms,
                                std::make_shared<Rehearsals>(gateway),
                                std::make_shared<RecipeRehearsals>(gateway)}};
    Request request;
    const auto first = line_of(text);
    request.method = method_named(first.substr(0, first.find(' ')));
    request.target = std::string(first.substr(std::min(first.find(' ') + 1, first.size())));
    request.peer = "127.0.0.1:1";
    request.headers.set("Host", "localhost");
    request.headers.set("Content-Type", "application/json");
    for (auto line = line_of(text); !line.empty(); line = line_of(text)) {
        const auto colon = line.find(':');
        if (colon != std::string_view::npos) request.headers.set(line.substr(0, colon), std::string(trimmed(line.substr(colon + 1))));
    }
    request.body = std::string(text);
    int later = 0;
    const auto handled = router.handle(request, [&later](Response r) {
        check_response(r);
        ++later;
    });
    if (handled.now) {
        check_response(*handled.now);
        check(later == 0);
    } else {
        check_response(handled.at_limit);
    }
    (void)router.route_of(request);
}

void feed_codec(std::string_view bytes) {
    // In one piece and byte by byte: the same messages, the same fault.
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    WebSocketParser whole(1000), pieces(1000);
    std::vector<WebSocketMessage> a, b;
    const auto fault = whole.take({data, bytes.size()}, a);
    std::optional<WebSocketFault> piece_fault;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (const auto f = pieces.take({data + i, 1}, b)) piece_fault = f;
    }
    check(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        check(a[i].kind == b[i].kind && a[i].payload == b[i].payload && a[i].code == b[i].code);
    check(fault.has_value() == piece_fault.has_value());
    if (fault) check(fault->code == piece_fault->code);
}

void feed_stream(std::string_view text) {
    test::FakeGateway gateway;
    Settings settings;
    Counters counters;
    StreamHub hub(gateway, settings, counters, {});
    const auto client = hub.add({});
    Instant now = at_ns(1'000'000'000);
    while (!text.empty()) {
        hub.on_text(*client, line_of(text), now);
        now += std::chrono::milliseconds(50);
        hub.on_deadline(now);
    }
    (void)client->queue.take(SIZE_MAX);
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
    switch (data[0] % 3) {
        case 0:
            feed_request(rest);
            break;
        case 1:
            feed_codec(rest);
            break;
        default:
            feed_stream(rest);
            break;
    }
    return 0;
}
