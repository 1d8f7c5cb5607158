// The small grammars of HTTP: input is read correctly or refused; output is always JSON.
#include "gateway/doors/http/text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/json/parse.hpp>
#include <cmath>
#include <limits>

namespace axisgate::http {
namespace {
using std::string_literals::operator""s;

TEST(HttpText, PercentDecoding) {
    struct Row {
        std::string text;
        std::optional<std::string> want;
    };
    for (const auto& [text, want] : {Row{"PP%5B5%5D", "PP[5]"}, Row{"PP[5]", "PP[5]"}, Row{"%c3%A4", "\xC3\xA4"}, Row{"", ""},
                                     Row{"a%2Fb", "a/b"}, Row{"a+b", "a+b"}, Row{"%", {}}, Row{"%4", {}}, Row{"%4x", {}}, Row{"%00", {}},
                                     Row{"%ff", {}}, Row{"%c3", {}}, Row{"%ed%a0%80", {}}, Row{"%c0%af", {}}}) {
        EXPECT_EQ(percent_decode(text), want) << text;
    }
    EXPECT_EQ(percent_decode("a+b%2B", true), "a b+");
    EXPECT_EQ(percent_encode("PP[5] \xC3\xA4~"), "PP%5B5%5D%20%C3%A4~");
}

TEST(HttpText, Targets) {
    const auto t = parse_target("/api/v1/axes/a%2Fb?wait=1&x=%41+b&&flag");
    ASSERT_TRUE(t);
    EXPECT_EQ(t->segments, (std::vector<std::string>{"api", "v1", "axes", "a/b"}));
    EXPECT_EQ(t->path, "") << "a slash inside a segment must not become part of a path";
    EXPECT_EQ(t->query.get("x"), "A b");
    EXPECT_EQ(t->query.get("flag"), "");
    EXPECT_EQ(t->query.get("y"), std::nullopt);
    EXPECT_EQ(parse_target("/")->path, "/");
    EXPECT_EQ(parse_target("/?a=1")->segments, std::vector<std::string>{""});
    EXPECT_EQ(parse_target("http://host:80/a/b")->path, "/a/b");
    EXPECT_EQ(parse_target("HTTP://host?q=1")->query.get("q"), "1");
    for (const auto* bad : {"", "a/b", "*", "/a b", "/a#b", "/%zz", "/a?%", "/a\tb", "/a\x7F", "/%00"})
        EXPECT_FALSE(parse_target(bad)) << bad;
}

TEST(HttpText, FlagsAndNumbers) {
    EXPECT_EQ(parse_flag("1"), true);
    EXPECT_EQ(parse_flag(""), true);
    EXPECT_EQ(parse_flag("false"), false);
    EXPECT_EQ(parse_flag("yes"), std::nullopt);
    EXPECT_EQ(parse_whole("12", 0, 12), 12);
    for (const auto* bad : {"", "13", "-1", "1.0", " 1", "1 ", "0x1", "99999999999999999999"})
        EXPECT_EQ(parse_whole(bad, 0, 12), std::nullopt) << bad;
    EXPECT_EQ(parse_number("0.5"), 0.5);
    for (const auto* bad : {"", "nan", "inf", "1e999", "1,5", "1s"})
        EXPECT_EQ(parse_number(bad), std::nullopt) << bad;
}

TEST(HttpText, Times) {
    EXPECT_EQ(format_time(1'767'323'045'678'901'234), "2026-01-02T03:04:05.678901Z");
    EXPECT_EQ(format_time(0), "1970-01-01T00:00:00.000000Z");
    EXPECT_EQ(format_time(-1), "1969-12-31T23:59:59.999999Z");
    struct Row {
        const char* text;
        std::optional<std::int64_t> want;
    };
    for (const auto& [text, want] :
         {Row{"1970-01-01T00:00:01Z", 1'000'000'000}, Row{"2026-01-02T03:04:05.678901234Z", 1'767'323'045'678'901'234},
          Row{"2026-01-02T04:04:05.5+01:00", 1'767'323'045'500'000'000}, Row{"2026-01-02T04:04:05 01:00", 1'767'323'045'000'000'000},
          Row{"2026-01-01T22:04:05-05:00", 1'767'323'045'000'000'000}, Row{"2024-02-29T00:00:00Z", 1'709'164'800'000'000'000},
          Row{"2023-02-29T00:00:00Z", {}}, Row{"2026-13-01T00:00:00Z", {}}, Row{"2026-01-01", {}}, Row{"2026-01-01T00:00:00", {}},
          Row{"2026-01-01T24:00:00Z", {}}, Row{"2026-01-01T00:00:00.Z", {}}, Row{"2026-01-01T00:00:00Zx", {}},
          Row{"9999-01-01T00:00:00Z", {}}, Row{"12", {}}, Row{"", {}}}) {
        EXPECT_EQ(parse_time(text), want) << text;
    }
}

TEST(HttpText, Accept) {
    struct Row {
        const char* accept;
        const char* media;
        bool want;
    };
    for (const auto& [accept, media, want] :
         {Row{"", "application/json", true}, Row{"*/*", "application/json", true}, Row{"application/*", "application/json", true},
          Row{"text/html, application/json;q=0.1", "application/json", true}, Row{"text/html", "application/json", false},
          Row{"application/json;q=0", "application/json", false}, Row{"*/*;q=1, application/json;q=0", "application/json", false},
          Row{"APPLICATION/JSON", "application/json", true}, Row{"application/jsonx", "application/json", false},
          Row{"application/openmetrics-text;version=1.0.0;q=0.5,text/plain;version=0.0.4;q=0.2,*/*;q=0.1", "text/plain", true},
          Row{",,", "application/json", false}, Row{";;;q=", "application/json", false}}) {
        EXPECT_EQ(accepts(accept, media), want) << accept;
    }
    const std::array<std::string_view, 3> media{"application/json", "text/plain", "application/x-pcapng"};
    EXPECT_EQ(best_accepted("", media), 0u);
    EXPECT_EQ(best_accepted("text/plain", media), 1u);
    EXPECT_EQ(best_accepted("application/json;q=0.5, application/x-pcapng", media), 2u);
    EXPECT_EQ(best_accepted("image/png", media), std::nullopt);
}

TEST(HttpText, MediaTypesAndTags) {
    EXPECT_EQ(media_of("Application/JSON"), "application/json");
    EXPECT_EQ(media_of("application/json; charset=UTF-8"), "application/json");
    EXPECT_EQ(media_of("application/json; charset=latin1"), "");
    EXPECT_EQ(media_of("application/json;profile=x"), "application/json");
    EXPECT_EQ(media_of(""), "");
    EXPECT_TRUE(tag_listed("\"3\"", "\"3\"", false));
    EXPECT_TRUE(tag_listed("\"2\", \"3\"", "\"3\"", false));
    EXPECT_TRUE(tag_listed("*", "\"3\"", false));
    EXPECT_FALSE(tag_listed("W/\"3\"", "\"3\"", false));
    EXPECT_TRUE(tag_listed("W/\"3\"", "\"3\"", true));
    EXPECT_FALSE(tag_listed("\"2,\"3\"\"", "\"3\"", false)) << "a comma inside quotes does not separate";
    EXPECT_FALSE(tag_listed("", "\"3\"", false));
    EXPECT_FALSE(tag_listed("3", "\"3\"", false));
}

TEST(HttpText, Hex) {
    const std::vector<std::uint8_t> bytes{0xAA, 0x05, 0x0F};
    EXPECT_EQ(to_hex(bytes), "AA050F");
    EXPECT_EQ(from_hex("AA 05\t0f"), bytes);
    EXPECT_EQ(from_hex(""), std::vector<std::uint8_t>{});
    for (const auto* bad : {"A", "A A", "GG", "AA0"})
        EXPECT_EQ(from_hex(bad), std::nullopt) << bad;
}

TEST(HttpText, JsonOut) {
    namespace json = boost::json;
    struct Row {
        json::value value;
        std::string want;
    };
    const double inf = std::numeric_limits<double>::infinity();
    for (const auto& [value, want] :
         {Row{100.0, "100"}, Row{0.1, "0.1"}, Row{-0.0, "0"}, Row{1e300, "1e+300"}, Row{12.5, "12.5"}, Row{inf, "null"},
          Row{std::nan(""), "null"}, Row{std::int64_t{-5}, "-5"}, Row{UINT64_MAX, "18446744073709551615"},
          Row{9007199254740993.0, "9007199254740992"}, Row{"a\"b\\\n\x01\xC3\xA4", "\"a\\\"b\\\\\\n\\u0001\xC3\xA4\""},
          Row{"\xFFok\xC3", "\"\xEF\xBF\xBDok\xEF\xBF\xBD\""}, Row{json::value(nullptr), "null"}}) {
        EXPECT_EQ(json_text(value), want);
    }
    const auto document = json::parse(R"({"b":[1,true,null,{"x":"y"}],"a":{}})");
    EXPECT_EQ(json_text(document), R"({"b":[1,true,null,{"x":"y"}],"a":{}})");
    EXPECT_EQ(json::parse(json_text(json::value(1.0 / 3))).to_number<double>(), 1.0 / 3) << "the shortest form is still the same number";
    EXPECT_EQ(number(inf), json::value(nullptr));
    EXPECT_TRUE(number(3.0).is_int64());
    EXPECT_TRUE(number(1e17).is_double());
    EXPECT_TRUE(text_or_null("").is_null());
}
}  // namespace
}  // namespace axisgate::http
