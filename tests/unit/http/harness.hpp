// A router with a FakeGateway, with calls that read like requests; the body of the answer is parsed.
#pragma once

#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

#include <string>

#include "gateway/doors/http/router.hpp"
#include "gateway/services/alarms/alarm_service.hpp"
#include "gateway/services/recipes/recipe_service.hpp"
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

Answer answer_from(Response r);

struct Harness {
    Harness();
    ~Harness();

    FakeGateway gateway;
    Settings settings;
    std::map<std::string, std::string, std::less<>> files;  ///< some files of a page, compressed and not, and others
    Instant clock = time_zero;                              ///< of the recipes
    std::shared_ptr<RecipeService> recipes;
    std::shared_ptr<AlarmService> alarms;
    std::shared_ptr<Rehearsals> rehearsals;
    std::shared_ptr<RecipeRehearsals> recipe_rehearsals;
    Router router;
    std::vector<Response> later;       ///< answers that came through Respond
    std::chrono::nanoseconds limit{};  ///< of the last promise
    Response at_limit;
    bool promised = false;

    static Request request(std::string_view method, std::string target, std::string body = {},
                           std::vector<std::pair<std::string, std::string>> headers = {});
    /// The answer, at once or (if the FakeGateway gave one inside the call) through the callback; status 0 if it is still outstanding.
    Answer call(std::string_view method, std::string target, std::string body = {},
                std::vector<std::pair<std::string, std::string>> headers = {});
    Answer send(const Request& r);
    /// The answer that came through the callback after a promise.
    Answer answered();
    /// Another router for the same gateway, with users and without a page.
    [[nodiscard]] Router with_users(std::shared_ptr<AccessPort> access);
};

class HttpTest : public ::testing::Test, public Harness {
protected:
    HttpTest();
    ~HttpTest() override;
};

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
