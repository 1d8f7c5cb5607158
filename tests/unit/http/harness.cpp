// The router with everything that it needs, and the calls of a test, compiled once.
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {

Answer answer_from(Response r) {
    Answer a;
    a.status = r.status;
    a.headers = std::move(r.headers);
    a.text = std::move(r.body);
    a.without_body = r.without_body;
    boost::system::error_code ec;
    if (auto v = boost::json::parse(a.text, ec); !ec) a.json = std::move(v);
    return a;
}

Harness::Harness()
    : files{{"web/dist/index.html", "<html>page</html>"},
            {"web/dist/assets/main.js", "let a = 1;"},
            {"web/dist/assets/big.js", "let big = 1;"},
            {"web/dist/assets/big.js.gz", "PACKED"},
            {"web/dist/help/index.html", "<html>contents</html>"},
            {"web/dist/help/fleet.html", "<html>fleet</html>"},
            {"web/dist/empty.txt", ""},
            {"web/secret.txt", "not for the page"},
            {"schema/openapi.yaml", "openapi: 3.0.3\n"}},
      recipes(std::make_shared<RecipeService>(gateway, [this] { return clock; })),
      alarms(std::make_shared<AlarmService>(gateway, [this] { return clock; })),
      rehearsals(std::make_shared<Rehearsals>(gateway)),
      recipe_rehearsals(std::make_shared<RecipeRehearsals>(gateway)),
      router(Context{
          gateway, settings,
          [this](std::string_view path) {
              const auto it = files.find(path);
              return it == files.end() ? std::string_view() : it->second.empty() ? std::string_view("", 0) : std::string_view(it->second);
          },
          [] { return std::string("axisgate_http_own 1\n"); }, std::make_shared<ChangeQueue>(), recipes, std::make_shared<AxisJobs>(),
          nullptr, alarms, rehearsals, recipe_rehearsals}) {}
Harness::~Harness() = default;

Router Harness::with_users(std::shared_ptr<AccessPort> access) {
    return Router{Context{.ports = gateway,
                          .settings = settings,
                          .asset = [](std::string_view) { return std::string_view(); },
                          .own_metrics = {},
                          .recipes = recipes,
                          .access = std::move(access),
                          .alarms = alarms,
                          .rehearsals = rehearsals,
                          .recipe_rehearsals = recipe_rehearsals}};
}

HttpTest::HttpTest() = default;
HttpTest::~HttpTest() = default;

Request Harness::request(std::string_view method, std::string target, std::string body,
                         std::vector<std::pair<std::string, std::string>> headers) {
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

Answer Harness::call(std::string_view method, std::string target, std::string body,
                     std::vector<std::pair<std::string, std::string>> headers) {
    return send(request(method, std::move(target), std::move(body), std::move(headers)));
}

Answer Harness::send(const Request& r) {
    later.clear();
    auto handled = router.handle(r, [this](Response x) { later.push_back(std::move(x)); });
    promised = !handled.now;
    limit = handled.limit;
    at_limit = handled.at_limit;
    if (handled.now) return answer_from(std::move(*handled.now));
    return {};
}

Answer Harness::answered() {
    EXPECT_EQ(later.size(), 1u);
    return later.empty() ? Answer{} : answer_from(later.front());
}

}  // namespace axisgate::http::test
