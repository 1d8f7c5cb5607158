// Heads of requests: their exact end, and forms that could be read in two ways.
#include "gateway/doors/http/head.hpp"

#include <gtest/gtest.h>

namespace axisgate::http::test {
namespace {
using Verdict = HeadScan::Verdict;

TEST(HttpHead, EndsAtItsEmptyLine) {
    const std::string head = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";
    for (std::size_t n = 1; n < head.size(); ++n)
        EXPECT_EQ(scan_head(head.substr(0, n), 1000).verdict, Verdict::incomplete) << n;
    const auto whole = scan_head(head + "body", 1000);
    EXPECT_EQ(whole.verdict, Verdict::whole);
    EXPECT_EQ(whole.bytes, head.size());
}

TEST(HttpHead, TheBoundIsExact) {
    const std::string head = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";
    EXPECT_EQ(scan_head(head, head.size()).verdict, Verdict::whole);
    EXPECT_EQ(scan_head(head, head.size() - 1).verdict, Verdict::too_large);
    EXPECT_EQ(scan_head("\r\n" + head, head.size()).verdict, Verdict::whole) << "an empty line in front is not of it";
    EXPECT_EQ(scan_head(head.substr(0, 20), 20).verdict, Verdict::too_large) << "it cannot end in time any more";
    EXPECT_EQ(scan_head(head.substr(0, 19), 20).verdict, Verdict::incomplete);
}

TEST(HttpHead, TwoEmptyLinesInFrontArePassedOver) {
    const std::string head = "GET / HTTP/1.1\r\nHost: a\r\n\r\n";
    EXPECT_EQ(scan_head("\r\n" + head, 1000).empty_lines, 2u);
    EXPECT_EQ(scan_head("\r\n\r\n" + head, 1000).verdict, Verdict::whole);
    EXPECT_EQ(scan_head("\r\n\r\n\r\n" + head, 1000).verdict, Verdict::malformed);
    EXPECT_EQ(scan_head("\r", 1000).verdict, Verdict::incomplete);
    EXPECT_EQ(scan_head("\r\n\r", 1000).verdict, Verdict::incomplete);
    for (const auto* bad : {"\n", "\rGET", "\r\n ", "\x16\x03\x01", " GET", "\xC3\xA4"})
        EXPECT_EQ(scan_head(bad, 1000).verdict, Verdict::malformed) << bad;
}

TEST(HttpHead, LinesThatTwoProgramsReadInTwoWays) {
    for (const std::string& bad :
         {std::string("GET / HTTP/1.1\r\nA: b\r\n c\r\n\r\n"), std::string("GET / HTTP/1.1\r\nA: b\r\n\tc\r\n\r\n"),
          std::string("GET / HTTP/1.1\nA: b\r\n\r\n"), std::string("GET / HTTP/1.1\r\nA: b\rX: c\r\n\r\n"),
          std::string("GET / HTTP/1.1\r\nA: \0b\r\n\r\n", 26), std::string("GET / HTTP/1.1\r\nA: b\n\r\n\r\n")})
        EXPECT_EQ(scan_head(bad, 1000).verdict, Verdict::malformed) << bad;
}

TEST(HttpHead, TheLengthOfTheBodyIsBeyondDoubt) {
    const auto status = [](std::vector<std::pair<std::string, std::string>> fields, bool old = false) {
        Headers h;
        h.fields = std::move(fields);
        const auto fault = framing_fault(h, old);
        return fault ? fault->status : 200u;
    };
    EXPECT_EQ(status({{"Content-Length", "5"}}), 200u);
    EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}}), 200u);
    EXPECT_EQ(status({{"transfer-encoding", "Chunked"}}), 200u);
    EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}}, true), 400u) << "HTTP/1.0";
    for (const auto* other : {"identity", "gzip", "gzip, chunked", "chunked, chunked", "chunked, identity", "chunked;q=1", "xchunked",
                              "\"chunked\"", "chunked,", ",chunked", "", "\vchunked"}) {
        EXPECT_EQ(status({{"Transfer-Encoding", other}}), 501u) << other;
        EXPECT_EQ(status({{"Transfer-Encoding", other}, {"Content-Length", "5"}}), 400u) << other;
        EXPECT_EQ(status({{"Content-Length", "5"}, {"Transfer-Encoding", other}}), 400u) << other;
    }
    EXPECT_EQ(status({{"Content-Length", "5"}, {"Transfer-Encoding", "chunked"}}), 400u);
    EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}, {"Content-Length", "5"}}), 400u);
    EXPECT_EQ(status({{"Transfer-Encoding", "chunked"}, {"Transfer-Encoding", "chunked"}}), 400u);
    for (const auto* name : {"Host", "Content-Length", "Content-Type", "Authorization", "Origin", "X-CSRF-Token", "X-Client", "Expect"}) {
        EXPECT_EQ(status({{name, "1"}}), 200u) << name;
        EXPECT_EQ(status({{name, "1"}, {"Accept", "a"}, {name, "1"}}), 400u) << name << ", even of one value";
    }
    EXPECT_EQ(status({{"Accept", "a"}, {"Accept", "b"}, {"Cookie", "a=1"}, {"Cookie", "b=2"}}), 200u) << "lists may stand twice";
}
}  // namespace
}  // namespace axisgate::http::test
