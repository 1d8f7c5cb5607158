// A router around a FakeGateway, with calls that read like requests.
// In: method, target, body, headers. Out: the answer with its body parsed.
#pragma once

#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

#include <string>

#include "gateway/doors/http/alarm_desk.hpp"
#include "gateway/doors/http/recipe_desk.hpp"
#include "gateway/doors/http/router.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::http::test {

struct Answer {
    unsigned status = 0;  ///< 0: nothing yet
    Headers headers;
    std::string text;
    bool without_body = false;
    boost::json::value json;  ///< null if the body is not JSON

    [[nodiscard]] const boost::json::object& object() const { return json.get_object(); }
    [[nodiscard]] const boost::json::array& array() const { return json.get_array(); }
    [[nodiscard]] std::string at(std::string_view key) const {
        const auto* v = json.is_object() ? json.get_object().if_contains(key) : nullptr;
        if (!v) return "(missing)";
        return v->is_string() ? std::string(v->get_string()) : json_text(*v);
    }
    [[nodiscard]] const boost::json::object& fault(std::size_t i = 0) const {
        return json.get_object().at("faults").get_array().at(i).get_object();
    }
};

inline Answer answer_from(Response r) {
    Answer a;
    a.status = r.status;
    a.headers = std::move(r.headers);
    a.text = std::move(r.body);
    a.without_body = r.without_body;
    boost::system::error_code ec;
    if (auto v = boost::json::parse(a.text, ec); !ec) a.json = std::move(v);
    return a;
}

struct Harness {
    FakeGateway gateway;
    Settings settings;
    std::map<std::string, std::string, std::less<>> files{{"web/dist/index.html", "<html>page</html>"},
                                                          {"web/dist/assets/main.js", "let a = 1;"},
                                                          {"web/dist/assets/big.js", "let big = 1;"},
                                                          {"web/dist/assets/big.js.gz", "PACKED"},
                                                          {"web/dist/empty.txt", ""},
                                                          {"web/secret.txt", "not for the page"},
                                                          {"schema/openapi.yaml", "openapi: 3.0.3\n"}};
    Instant clock = time_zero;  ///< of the recipes
    std::shared_ptr<RecipeDesk> recipes = std::make_shared<RecipeDesk>(gateway, [this] { return clock; });
    std::shared_ptr<AlarmDesk> alarms = std::make_shared<AlarmDesk>(gateway, [this] { return clock; });
    Router router{Context{gateway, settings,
                          [this](std::string_view path) {
                              const auto it = files.find(path);
                              return it == files.end()    ? std::string_view()
                                     : it->second.empty() ? std::string_view("", 0)
                                                          : std::string_view(it->second);
                          },
                          [] { return std::string("axisgate_http_own 1\n"); }, std::make_shared<ChangeQueue>(), recipes, std::make_shared<AxisJobs>(), nullptr, alarms}};
    std::vector<Response> later;       ///< answers that came through Respond
    std::chrono::nanoseconds limit{};  ///< of the last promise
    Response at_limit;
    bool promised = false;

    static Request request(std::string_view method, std::string target, std::string body = {},
                           std::vector<std::pair<std::string, std::string>> headers = {}) {
        Request r;
        r.method = method_named(method);
        r.target = std::move(target);
        r.body = std::move(body);
        r.peer = "127.0.0.1:51123";
        r.headers.fields = std::move(headers);
        if (r.headers.count("Host") == 0) r.headers.set("Host", "127.0.0.1:8080");
        if (!r.body.empty() && r.headers.count("Content-Type") == 0) r.headers.set("Content-Type", "application/json");
        return r;
    }
    /// The answer, be it at once or (if the FakeGateway gave one inside the call) through the callback; status 0 if it is still to come.
    Answer call(std::string_view method, std::string target, std::string body = {},
                std::vector<std::pair<std::string, std::string>> headers = {}) {
        return send(request(method, std::move(target), std::move(body), std::move(headers)));
    }
    Answer send(const Request& r) {
        later.clear();
        auto handled = router.handle(r, [this](Response x) { later.push_back(std::move(x)); });
        promised = !handled.now;
        limit = handled.limit;
        at_limit = handled.at_limit;
        if (handled.now) return answer_from(std::move(*handled.now));
        return {};
    }
    /// What came through the callback after a promise.
    Answer answered() {
        EXPECT_EQ(later.size(), 1u);
        return later.empty() ? Answer{} : answer_from(later.front());
    }
};

class HttpTest : public ::testing::Test, public Harness {};

inline Result good_result(Outcome outcome = Outcome::accepted) {
    Result r;
    r.outcome = outcome;
    return r;
}
inline Result bad_result(Reason reason, std::string text, std::int32_t code = 0, Outcome outcome = Outcome::refused) {
    Result r;
    r.outcome = outcome;
    r.reason = reason;
    r.text = std::move(text);
    r.code = code;
    return r;
}

}  // namespace axisgate::http::test
