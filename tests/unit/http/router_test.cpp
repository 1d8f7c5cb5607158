// Rules for all routes: methods, hosts, origins, media types, errors, headers; and the page's files.
#include "gateway/doors/http/static_files.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

TEST_F(HttpTest, ProblemsHaveTheMembersOfRfc9457) {
    const auto a = call("GET", "/api/v1/axes/none");
    EXPECT_EQ(a.status, 404u);
    EXPECT_EQ(a.headers.get("Content-Type"), "application/problem+json");
    EXPECT_EQ(a.at("type"), "urn:axisgate:problem:not_found");
    EXPECT_EQ(a.at("title"), "Not found");
    EXPECT_EQ(a.at("status"), "404");
    EXPECT_EQ(a.at("detail"), "there is no axis none");
    EXPECT_EQ(a.at("code"), "null");
    EXPECT_EQ(a.at("reason"), "not_found");
}

TEST_F(HttpTest, UnknownPathsAreProblems) {
    for (const auto* path : {"/api", "/api/", "/api/v1", "/api/v1/", "/api/v2/axes", "/api/v1/recipe", "/api/v1/axes/feeder/nothing",
                             "/api/v1/axes/", "/api/v1/axes/feeder/", "/api/v1//axes", "/api/v1/axes/feeder/commands/1", "/api/v1/Axes"}) {
        for (const auto* method : {"GET", "POST", "OPTIONS"}) {
            const auto a = call(method, path, method == std::string_view("POST") ? "{}" : "");
            EXPECT_EQ(a.status, 404u) << method << " " << path;
            EXPECT_EQ(a.at("reason"), "not_found");
        }
    }
}

TEST_F(HttpTest, NamesThatAQueryDoesNotHaveAreRefusedEverywhere) {
    for (const auto& route : all_routes()) {
        std::string path;
        for (std::size_t i = 0; i < route.path.size(); ++i) {
            path += route.path[i] == '{' ? 'x' : route.path[i];
            if (route.path[i] == '{') i = route.path.find('}', i);
        }
        const bool csv = route.takes == Route::Takes::csv, bytes = route.takes == Route::Takes::bytes;
        std::vector<std::pair<std::string, std::string>> headers;
        if (route.takes != Route::Takes::nothing)
            headers.emplace_back("Content-Type", csv ? "text/csv" : bytes ? "application/octet-stream" : "application/json");
        std::vector<std::string> queries{"?nonsense=1", "?", "?=", "?=1"};
        for (const auto word : {"dry_run", "wait", "force"})
            if (route.query.find(word) == std::string_view::npos) queries.push_back(std::string("?") + word + "=1");
        if (!route.query.empty()) {
            const std::string first(route.query.substr(0, route.query.find(' ')));
            queries.push_back("?" + first + "=1&" + first + "=1");
            queries.push_back("?" + first + "=1&other=1");
        }
        for (const auto& query : queries) {
            if (query == "?") continue;                           // an empty query is none
            if (route.needed() == Role::administrator) continue;  // the identity is checked first: see roles_test
            const auto a = call(name_of(route.method), path + query, route.takes == Route::Takes::nothing ? "" : "{}", headers);
            EXPECT_EQ(a.status, 400u) << name_of(route.method) << " " << path << query << " " << a.text;
            EXPECT_EQ(a.at("reason"), "bad_request") << path << query;
            EXPECT_EQ(a.headers.get("Content-Type"), "application/problem+json") << path << query;
        }
    }
    EXPECT_TRUE(gateway.submitted.empty());
    EXPECT_EQ(call("GET", "/api/v1/about?").status, 200u);
    EXPECT_EQ(call("GET", "/index.html?v=12").status, 200u) << "files of the page are no operations";
    EXPECT_EQ(call("GET", "/api/v1/events?dry_run=1").at("detail"),
              "\"dry_run\" is not known here: the query may have since, axis, severity, kind, state, before, limit, order, format");
    EXPECT_EQ(call("GET", "/api/v1/about?dry_run=1").at("detail"), "\"dry_run\" is not known here: this takes no query");
}

TEST_F(HttpTest, MethodsThatARouteDoesNotHave) {
    const auto a = call("DELETE", "/api/v1/site");
    EXPECT_EQ(a.status, 405u);
    EXPECT_EQ(a.headers.get("Allow"), "GET, HEAD, PUT, OPTIONS");
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder", "{}").status, 405u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/commands").headers.get("Allow"), "POST, OPTIONS");
    EXPECT_EQ(call("HEAD", "/api/v1/axes/feeder/commands").status, 405u);
    EXPECT_EQ(call("BREW", "/api/v1/about").status, 405u);
    EXPECT_EQ(call("POST", "/index.html", "{}").headers.get("Allow"), "GET, HEAD, OPTIONS");
}

TEST_F(HttpTest, OptionsAndHead) {
    const auto o = call("OPTIONS", "/api/v1/axes/feeder");
    EXPECT_EQ(o.status, 204u);
    EXPECT_EQ(o.headers.get("Allow"), "GET, HEAD, PUT, PATCH, DELETE, OPTIONS");
    EXPECT_EQ(o.headers.get("Access-Control-Allow-Origin"), "");
    EXPECT_EQ(call("OPTIONS", "*").status, 204u);
    const auto get = call("GET", "/api/v1/about");
    const auto head = call("HEAD", "/api/v1/about");
    EXPECT_EQ(head.status, 200u);
    EXPECT_TRUE(head.without_body);
    EXPECT_EQ(head.text.size(), get.text.size()) << "measured, so that Content-Length is right";
    EXPECT_EQ(head.headers.get("Content-Type"), get.headers.get("Content-Type"));
    EXPECT_FALSE(get.without_body);
}

TEST_F(HttpTest, SecurityHeadersEverywhere) {
    for (const auto* path : {"/api/v1/about", "/", "/nothing.js", "/api/v1/none", "/metrics"}) {
        const auto a = call("GET", path);
        EXPECT_EQ(a.headers.get("X-Content-Type-Options"), "nosniff") << path;
        EXPECT_EQ(a.headers.get("Referrer-Policy"), "no-referrer") << path;
        EXPECT_TRUE(a.headers.get("Content-Security-Policy").starts_with("default-src 'self'")) << path;
        EXPECT_EQ(a.headers.get("Content-Security-Policy").find("unsafe"), std::string_view::npos);
        EXPECT_EQ(a.headers.get("X-Frame-Options"), "DENY") << path;
    }
    EXPECT_EQ(call("GET", "/api/v1/about").headers.get("Cache-Control"), "no-store");
    EXPECT_EQ(call("GET", "/").headers.get("Cache-Control"), "no-cache");
    EXPECT_EQ(call("GET", "/help/").headers.get("Cache-Control"), "no-cache");
    EXPECT_EQ(call("GET", "/assets/main.js").headers.get("Cache-Control"), "max-age=31536000, immutable");
    EXPECT_NE(call("GET", "/assets/gone.js").headers.get("Cache-Control"), "max-age=31536000, immutable");
}

TEST_F(HttpTest, HostsThatAreNotListedAreMisdirectedWhateverTheBind) {
    for (const auto* bind :
         {"127.0.0.1:8080", "[::1]:8080", "localhost:8080", "0.0.0.0:8080", "[::]:8080", "192.0.2.7:8080", "*:8080", ":8080"}) {
        settings.bind = bind;
        settings.allowed_hosts.clear();
        const auto with = [this](std::string host) { return call("GET", "/api/v1/about", "", {{"Host", std::move(host)}}).status; };
        for (const auto* good :
             {"127.0.0.1:8080", "127.0.0.1", "localhost", "LOCALHOST:1", "page.localhost", "[::1]:8080", "localhost.", "127.1.2.3"})
            EXPECT_EQ(with(good), 200u) << bind << ' ' << good;
        for (const auto* bad : {"evil.example", "evil.example:8080", "", "127.0.0.1.evil.example", "localhost.evil.example", "1.2.3",
                                "1.2.3.4.5", "256.1.1.1", "gateway", ":8080"})
            EXPECT_EQ(with(bad), 421u) << bind << ' ' << bad;
        settings.allowed_hosts = {"Gateway.example", "*"};
        EXPECT_EQ(with("gateway.EXAMPLE:8080"), 200u) << bind;
        EXPECT_EQ(with("gateway.example."), 200u) << bind;
        EXPECT_EQ(with("evil.example"), 421u) << bind << ": no name stands for all";
    }
    EXPECT_EQ(call("GET", "/healthz", "", {{"Host", "evil.example"}}).at("reason"), "misdirected");
    EXPECT_EQ(call("GET", "/", "", {{"Host", "evil.example"}}).status, 421u) << "the page too";
    EXPECT_EQ(call("GET", "http://evil.example/api/v1/about", "", {{"Host", "localhost"}}).status, 421u) << "an absolute target counts";
}

TEST_F(HttpTest, AnAddressOfAnotherWayInIsServedButIsNotThisMachine) {
    for (const auto* host : {"192.0.2.7", "192.0.2.7:8080", "[2001:db8::1]", "[2001:db8::1]:80"}) {
        EXPECT_EQ(call("GET", "/healthz", "", {{"Host", host}}).status, 200u) << host;
        EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Host", host}}).status, 401u) << host;
        EXPECT_EQ(call("GET", "http://" + std::string(host) + "/api/v1/about", "", {{"Host", "localhost"}}).status, 401u) << host;
    }
}

TEST_F(HttpTest, WhatAProxyWritesTakesLocalAccessAway) {
    EXPECT_EQ(call("GET", "/api/v1/about").status, 200u);
    for (const auto* name :
         {"Forwarded", "X-Forwarded-For", "x-forwarded-host", "X-FORWARDED-PROTO", "X-Forwarded-Prefix", "X-Forwarded", "X-Real-IP", "Via",
          "X-Client-IP", "X-Cluster-Client-Ip", "X-Original-Forwarded-For", "X-Original-Host", "X-Envoy-External-Address", "True-Client-IP",
          "CF-Connecting-IP", "Fastly-Client-IP", "Client-IP", "CDN-Loop", "Proxy-Connection"}) {
        EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Host", "localhost"}, {name, "192.0.2.9"}}).status, 401u) << name;
        EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Host", "localhost"}, {name, ""}}).status, 401u) << name << ", empty";
    }
    for (const auto* name : {"X-Client", "Cache-Control", "Pragma", "Priority", "TE", "From", "X-Requested-With"})
        EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Host", "localhost"}, {name, "x"}}).status, 200u) << name;
}

TEST_F(HttpTest, HostHeaderItself) {
    auto r = request("GET", "/healthz");
    r.headers.fields.clear();
    EXPECT_EQ(send(r).status, 400u);
    r.http_1_0 = true;
    EXPECT_EQ(send(r).status, 200u) << "HTTP/1.0 has none";
    r.headers.fields = {{"Host", "localhost"}, {"host", "localhost"}};
    EXPECT_EQ(send(r).status, 400u);
    for (const auto* bad : {"a b", "localhost:", "localhost:x", "localhost:8080:1", "localhost:65536", "me@localhost", "localhost/",
                            "local\x7Fhost", "[x]", "[::1", "[::1]x", "[::1]:", "::1", "localhost, evil.example"}) {
        r.headers.fields = {{"Host", bad}};
        EXPECT_EQ(send(r).status, std::string_view(bad) == "localhost:" || std::string_view(bad) == "[::1]:" ? 200u : 400u) << bad;
    }
}

TEST_F(HttpTest, RequestsOfOtherSitesCannotChangeAnything) {
    gateway.at_once = [](const Command&) { return good_result(); };
    const auto with = [this](std::string origin, std::string host = "127.0.0.1:8080") {
        return call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})",
                    {{"Host", std::move(host)}, {"Origin", std::move(origin)}})
            .status;
    };
    for (const auto* good : {"http://127.0.0.1:8080", "https://127.0.0.1:8080", "HTTP://127.0.0.1:8080"})
        EXPECT_EQ(with(good), 200u) << good;
    EXPECT_EQ(with("http://localhost", "localhost"), 200u);
    EXPECT_EQ(with("http://localhost:80", "localhost"), 200u) << "the port that goes without saying";
    const auto commands = gateway.submitted.size();
    for (const auto* bad : {"http://evil.example", "http://127.0.0.1:8081", "http://127.0.0.1", "null", "", "ftp://127.0.0.1:8080",
                            "127.0.0.1:8080", "http://127.0.0.1:8080.evil.example"}) {
        EXPECT_EQ(with(bad), 403u) << bad;
    }
    EXPECT_EQ(gateway.submitted.size(), commands) << "nothing got through";
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})", {{"Sec-Fetch-Site", "cross-site"}}).status, 403u);
    EXPECT_EQ(call("DELETE", "/api/v1/axes/feeder", "", {{"Origin", "http://evil.example"}}).status, 403u);
    EXPECT_EQ(call("PUT", "/api/v1/site", "{}", {{"Origin", "http://evil.example"}}).status, 403u);
    EXPECT_EQ(call("GET", "/api/v1/axes", "", {{"Origin", "http://evil.example"}}).status, 200u) << "reading is the browser's to forbid";
}

TEST_F(HttpTest, Bodies) {
    const std::string path = "/api/v1/axes/feeder/commands";
    EXPECT_EQ(call("POST", path, R"({"command":"enable"})", {{"Content-Type", "text/plain"}}).status, 415u);
    EXPECT_EQ(call("POST", path, "command=enable", {{"Content-Type", "application/x-www-form-urlencoded"}}).status, 415u);
    EXPECT_EQ(call("POST", path, R"({"command":"enable"})", {{"Content-Type", "application/json; charset=iso-8859-1"}}).status, 415u);
    EXPECT_EQ(call("POST", path, R"({"command":"enable"})", {{"Content-Type", "application/merge-patch+json"}}).status, 415u)
        << "that is for PATCH";
    EXPECT_EQ(call("POST", path).status, 415u) << "no body at all";
    EXPECT_EQ(call("POST", path, R"({"command":"enable"})", {{"Content-Type", "application/json;charset=utf-8"}}).status, 0u);
    for (const auto* bad :
         {"{", "[]", "5", "null", "\"x\"", "{\"command\":\"enable\"} x", "{\"command\":\"\xFF\"}", "{'command':'enable'}"}) {
        const auto a = call("POST", path, bad);
        EXPECT_EQ(a.status, 400u) << bad;
        EXPECT_EQ(a.at("reason"), "bad_request");
    }
    EXPECT_EQ(call("POST", path, std::string(100000, '[')).status, 400u) << "depth is bounded";
    const auto commands = gateway.submitted.size();
    const auto twice = call("POST", path, "{\"command\":\"halt\",\n\"\\u0063ommand\":\"enable\"}");
    EXPECT_EQ(twice.status, 400u) << twice.text;
    EXPECT_EQ(twice.at("reason"), "bad_request");
    EXPECT_EQ(twice.at("detail"), "the member \"command\" stands twice (/command, line 2): keep one of them");
    EXPECT_EQ(twice.fault().at("pointer"), "/command");
    EXPECT_EQ(call("PUT", "/api/v1/site", R"({"lines":[{"name":"a"},{"name":"b","uri":"x","name":"c"}]})").fault().at("pointer"),
              "/lines/1/name");
    EXPECT_EQ(call("PUT", "/api/v1/recipes/x", R"({"steps":[{"wait_s":1,"wait_s":2}]})").status, 400u);
    EXPECT_EQ(gateway.submitted.size(), commands) << "neither of the two was done";
    const auto patch = call("PATCH", "/api/v1/axes/feeder", R"({"unit":"deg"})", {{"Content-Type", "application/merge-patch+json"}});
    EXPECT_EQ(patch.status, 200u);
}

TEST_F(HttpTest, PackedBodiesAreNotTakenForPlainOnes) {
    const auto with = [this](std::string coding) {
        return call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})", {{"Content-Encoding", std::move(coding)}});
    };
    for (const auto* good : {"identity", "Identity", "", " identity , identity"})
        EXPECT_EQ(with(good).status, 0u) << good;
    const auto commands = gateway.submitted.size();
    for (const auto* bad : {"gzip", "br", "identity, gzip", "x"}) {
        const auto a = with(bad);
        EXPECT_EQ(a.status, 415u) << bad;
        EXPECT_EQ(a.headers.get("Accept-Encoding"), "identity");
    }
    EXPECT_EQ(with("gzip").at("detail"), "the body comes with Content-Encoding: gzip: send it as it is, without one");
    EXPECT_EQ(gateway.submitted.size(), commands);
    EXPECT_EQ(call("PUT", "/api/v1/mappings.csv", "x", {{"Content-Type", "text/csv"}, {"Content-Encoding", "gzip"}}).status, 415u);
}

TEST_F(HttpTest, Accept) {
    EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Accept", "text/html"}}).status, 406u);
    EXPECT_EQ(call("GET", "/api/v1/about", "", {{"Accept", "text/html, */*;q=0.1"}}).status, 200u);
    EXPECT_EQ(call("GET", "/metrics", "", {{"Accept", "application/json"}}).status, 406u);
    EXPECT_EQ(call("GET", "/api/v1/openapi.yaml", "", {{"Accept", "application/yaml"}}).status, 200u);
    EXPECT_EQ(call("DELETE", "/api/v1/drives/bare", "", {{"Accept", "text/html"}}).status, 204u)
        << "it gives nothing that could be refused";
}

TEST_F(HttpTest, BadTargets) {
    for (const auto* target : {"", "api/v1/about", "/api/v1/axes/%zz", "/api/v1/axes/%00", "/a b", "//x:y z", "/api/v1/axes/%ff"})
        EXPECT_EQ(call("GET", target).status, 400u) << target;
    EXPECT_EQ(call("GET", "http://127.0.0.1:8080/healthz").status, 200u) << "absolute form";
    // The host in the target counts, whatever the header contains.
    EXPECT_EQ(call("GET", "http://evil.example/api/v1/about").status, 421u);
    EXPECT_NE(call("GET", "HTTPS://evil.example?x").at("detail").find("evil.example"), std::string::npos);
    EXPECT_EQ(call("GET", "http://localhost/healthz", "", {{"Host", "evil.example"}}).status, 200u);
    EXPECT_EQ(call("GET", "http:///healthz").status, 400u) << "no host at all";
    auto old = request("GET", "http://evil.example/healthz");
    old.headers.fields.clear();
    old.http_1_0 = true;
    EXPECT_EQ(send(old).status, 421u) << "HTTP/1.0 without the header";
    EXPECT_EQ(call("PUT", "http://localhost/api/v1/site", "{}", {{"Origin", "http://127.0.0.1:8080"}}).status, 403u)
        << "another origin than the host that is meant";
}

TEST_F(HttpTest, AnExceptionIsA500) {
    gateway.at_once = [](const Command&) -> Result { throw std::runtime_error("out of memory"); };
    const auto a = call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})");
    EXPECT_EQ(a.status, 500u);
    EXPECT_EQ(a.at("reason"), "internal");
}

TEST_F(HttpTest, AnAnswerFromInsideTheCallIsAnAnswerAtOnce) {
    gateway.at_once = [](const Command&) { return good_result(); };
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})").status, 200u);
    EXPECT_FALSE(promised);
    EXPECT_TRUE(later.empty()) << "told once, not twice";
}

TEST_F(HttpTest, FilesGoPackedToWhoTakesThem) {
    struct Case {
        const char* field;
        bool packed;
    };
    for (const auto& [field, packed] :
         {Case{"gzip, deflate, br", true}, Case{"br;q=1.0, GZIP ; q=0.5", true}, Case{"*", true}, Case{"", false}, Case{"br", false},
          Case{"gzip;q=0", false}, Case{"gzip;q=0, *", false}, Case{"*;q=0", false}}) {
        const auto a = call("GET", "/assets/big.js", "", {{"Accept-Encoding", field}});
        EXPECT_EQ(a.status, 200u) << field;
        EXPECT_EQ(a.text, packed ? "PACKED" : "let big = 1;") << field;
        EXPECT_EQ(a.headers.get("Content-Encoding"), packed ? "gzip" : "") << field;
        EXPECT_EQ(a.headers.get("Content-Type"), "text/javascript; charset=utf-8") << field;
        EXPECT_EQ(a.headers.get("Vary"), "Accept-Encoding") << field;
    }
    const std::string plain(call("GET", "/assets/big.js").headers.get("ETag"));
    const std::string packed(call("GET", "/assets/big.js", "", {{"Accept-Encoding", "gzip"}}).headers.get("ETag"));
    EXPECT_NE(plain, packed);
    const auto same = call("GET", "/assets/big.js", "", {{"Accept-Encoding", "gzip"}, {"If-None-Match", packed}});
    EXPECT_EQ(same.status, 304u);
    EXPECT_EQ(same.headers.get("Content-Encoding"), "");
    EXPECT_EQ(same.headers.get("Vary"), "Accept-Encoding");
    EXPECT_EQ(call("GET", "/assets/big.js", "", {{"Accept-Encoding", "gzip"}, {"If-None-Match", plain}}).status, 200u);
    const auto small = call("GET", "/assets/main.js", "", {{"Accept-Encoding", "gzip"}});
    EXPECT_EQ(small.text, "let a = 1;") << "there is no packed one";
    EXPECT_EQ(small.headers.count("Vary"), 0u);
}

TEST_F(HttpTest, TheHandbookIsServedAndWhatItHasNotIsNotThePage) {
    const std::vector<std::pair<std::string, std::string>> browser{{"Accept", "text/html,*/*;q=0.8"}};
    for (const auto* path : {"/help", "/help/", "/help/index.html"})
        EXPECT_EQ(call("GET", path, "", browser).text, "<html>contents</html>") << path;
    const auto chapter = call("GET", "/help/fleet.html");
    EXPECT_EQ(chapter.text, "<html>fleet</html>");
    EXPECT_EQ(chapter.headers.get("Content-Type"), "text/html; charset=utf-8");
    EXPECT_NE(chapter.headers.get("Content-Security-Policy").find("default-src 'self'"), std::string::npos);
    for (const auto* path : {"/help/nothing.html", "/help/fleet", "/help/../secret.txt", "/help/%2e%2e/secret.txt"})
        EXPECT_NE(call("GET", path, "", browser).status, 200u) << path;
    EXPECT_EQ(call("GET", "/help/nothing.html", "", browser).status, 404u);
    EXPECT_EQ(call("GET", "/helpers", "", browser).text, "<html>page</html>") << "an address of the page";
    EXPECT_EQ(call("POST", "/help/", "{}").status, call("POST", "/index.html", "{}").status);
}

TEST_F(HttpTest, StaticFiles) {
    const auto page = call("GET", "/");
    EXPECT_EQ(page.status, 200u);
    EXPECT_EQ(page.text, "<html>page</html>");
    EXPECT_EQ(page.headers.get("Content-Type"), "text/html; charset=utf-8");
    const std::string tag(page.headers.get("ETag"));
    EXPECT_EQ(tag.size(), 18u);
    const std::vector<std::pair<std::string, std::string>> browser{
        {"Accept", "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8"}};
    for (const auto* route : {"/axes", "/axes/feeder", "/a/b/c", "/index.html", "/axes/portal.x", "/lines/com1.js?tab=2", "/missing.js"})
        EXPECT_EQ(call("GET", route, "", browser).text, page.text) << route;
    EXPECT_EQ(call("GET", "/axes/portal.x", "", browser).headers.get("Vary"), "Accept");
    for (const auto* route : {"/nope", "/axes", "/axes/portal.x"}) {
        for (const auto* accept : {"*/*", "application/json", "", "text/html;q=0", "text/*"}) {
            const auto none = call("GET", route, "", {{"Accept", accept}});
            EXPECT_EQ(none.status, 404u) << route << accept;
            EXPECT_EQ(none.headers.get("Content-Type"), "application/problem+json");
        }
    }
    for (const auto* route : {"/assets", "/assets/missing.js", "/api", "/api/v1/nothing", "/healthz/x", "/readyz/x", "/metrics/x"})
        EXPECT_EQ(call("GET", route, "", browser).status, 404u) << route;
    const auto js = call("GET", "/assets/main.js");
    EXPECT_EQ(js.text, "let a = 1;");
    EXPECT_EQ(js.headers.get("Content-Type"), "text/javascript; charset=utf-8");
    EXPECT_NE(js.headers.get("ETag"), tag);
    const auto same = call("GET", "/", "", {{"If-None-Match", "\"x\", W/" + tag}});
    EXPECT_EQ(same.status, 304u);
    EXPECT_TRUE(same.without_body);
    EXPECT_EQ(same.headers.get("ETag"), tag);
    EXPECT_EQ(call("GET", "/", "", {{"If-None-Match", "\"x\""}}).status, 200u);
    EXPECT_EQ(call("GET", "/empty.txt").status, 200u) << "an empty file is a file";
    EXPECT_TRUE(call("HEAD", "/").without_body);
    EXPECT_EQ(call("GET", "/missing.js").status, 404u);
    EXPECT_EQ(call("GET", "/missing.js").at("reason"), "not_found");
}

TEST_F(HttpTest, PathsThatWantToLeadOut) {
    for (const auto* path :
         {"/../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt", "/assets/..%2f..%2f..%2fsecret.txt", "/assets/../../secret.txt",
          "/.git/config", "/..\\secret.txt", "/%2e%2e%5csecret.txt", "/a%0Ab", "//etc/passwd.txt", "/web/dist/index.html"}) {
        const auto a = call("GET", path);
        EXPECT_EQ(a.status, 404u) << path;
        EXPECT_EQ(a.text.find("not for the page"), std::string::npos) << path;
    }
}

TEST_F(HttpTest, APageThatIsNotBuiltIn) {
    files.erase("web/dist/index.html");
    const auto a = call("GET", "/");
    EXPECT_EQ(a.status, 404u);
    EXPECT_NE(a.at("detail").find("openapi.yaml"), std::string::npos);
}

TEST_F(HttpTest, MediaTypesOfFiles) {
    EXPECT_EQ(media_for("/a.css"), "text/css; charset=utf-8");
    EXPECT_EQ(media_for("/a.svg"), "image/svg+xml");
    EXPECT_EQ(media_for("/a.woff2"), "font/woff2");
    EXPECT_EQ(media_for("/a.webp"), "image/webp");
    EXPECT_EQ(media_for("/a.unknown"), "application/octet-stream");
}

TEST_F(HttpTest, RoutesForCounters) {
    EXPECT_EQ(router.route_of(request("GET", "/api/v1/axes/feeder?x=1")), "/api/v1/axes/{axis}");
    EXPECT_EQ(router.route_of(request("GET", "/api/v1/none")), "none");
    EXPECT_EQ(router.route_of(request("GET", "/anything.js")), "static");
    EXPECT_EQ(router.route_of(request("GET", "%")), "none");
}

TEST_F(HttpTest, WhatMayMoveSomethingIsKnownBeforeItIsHandled) {
    const auto moves = [this](std::string_view method, std::string target) { return router.moves(request(method, std::move(target))); };
    EXPECT_TRUE(moves("POST", "/api/v1/axes/feeder/commands?wait=5"));
    EXPECT_TRUE(moves("POST", "/api/v1/moves/start"));
    EXPECT_TRUE(moves("POST", "/api/v1/axes/none/actions")) << "that there is no such axis is the handler's to say";
    EXPECT_FALSE(moves("PUT", "/api/v1/axes/feeder/parameters/AC"));
    EXPECT_FALSE(moves("GET", "/api/v1/axes/feeder"));
    EXPECT_FALSE(moves("GET", "/api/v1/axes/feeder/commands"));
    EXPECT_FALSE(moves("POST", "/api/v1/none"));
    EXPECT_FALSE(moves("POST", "%"));
    EXPECT_EQ(std::ranges::count_if(all_routes(), [](const Route& r) { return r.commands; }), 5) << "a new one is looked at here";
}

TEST(HttpHosts, SameHost) {
    EXPECT_TRUE(same_host("http://[::1]:8080", "[::1]:8080"));
    EXPECT_TRUE(same_host("http://[::1]", "[::1]"));
    EXPECT_TRUE(same_host("https://a.example:443", "a.example"));
    EXPECT_FALSE(same_host("https://a.example", "a.example:80"));
    EXPECT_FALSE(same_host("http://", ""));
    EXPECT_FALSE(same_host("http://a", ""));
}
}  // namespace
}  // namespace axisgate::http::test
