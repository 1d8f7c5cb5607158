// Fuzz target for a table of parameters that is written back, through the router with a fake gateway: the query up to the first line end,
// then the file. Laws: one whole answer; a file with a fault writes nothing; written values are in the catalogue's range.
#include <boost/json/parse.hpp>

#include "gateway/doors/http/router.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/unit/http/fake_gateway.hpp"

using namespace axisgate;
using namespace axisgate::http;
using fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 32 * 1024) return 0;
    std::string_view text(reinterpret_cast<const char*>(data), size);
    http::test::FakeGateway gateway;
    std::size_t written = 0;
    gateway.at_once = [&](const Command& c) {
        Result r;
        if (const auto* w = std::get_if<WriteParameter>(&c.body)) {
            ++written;
            require(known(w->value), "a value is written, or nothing");
            r.value = w->value;
        } else {
            r.value = Value{std::int64_t{1}};
        }
        return r;
    };
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
                                alarms}};
    Request request;
    const auto end = text.find('\n');
    const std::string_view query = text.substr(0, end);
    request.method = Method::put;
    request.target = "/api/v1/axes/feeder/parameters.csv";
    if (!query.empty() && query[0] == '?') request.target += query;
    request.peer = "127.0.0.1:1";
    request.headers.set("Host", "localhost");
    request.headers.set("Content-Type", "text/csv");
    request.body = std::string(end == std::string_view::npos ? std::string_view() : text.substr(end + 1));
    std::optional<Response> answer;
    int answers = 0;
    auto handled = router.handle(request, [&](Response r) {
        answer = std::move(r);
        ++answers;
    });
    if (handled.now) {
        require(answers == 0, "one answer");
        answer = std::move(handled.now);
    }
    require(answers <= 1, "one answer");
    if (!answer) return 0;
    require(answer->status >= 200 && answer->status <= 599, "a status");
    if (answer->headers.get("Content-Type").ends_with("json")) {
        boost::system::error_code ec;
        (void)boost::json::parse(answer->body, ec);
        require(!ec, "JSON where it says JSON");
    }
    require(answer->status < 400 || written == 0 || answer->status >= 500, "a file that is refused writes nothing");
    require(request.target.find("dry_run=1") == std::string::npos || written == 0, "a dry run writes nothing");
    return 0;
}
