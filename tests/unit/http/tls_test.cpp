// Made certificates are valid and have the right names, and every fault of a pair is reported in words.
#include "gateway/doors/http/tls.hpp"

#include <gmock/gmock.h>

namespace axisgate::http::test {
namespace {
using ::testing::HasSubstr;
constexpr std::int64_t now_s = 1'795'000'000;  // November 2026
constexpr std::int64_t day_s = 86'400;
const std::vector<std::string> names{"localhost", "127.0.0.1", "::1", "192.0.2.7", "line3.plant.example", "line_4"};

TlsPem made() { return make_self_signed(names, now_s).value_or(TlsPem{}); }

TEST(Tls, MadeCertificateIsTaken) {
    const auto pem = made();
    EXPECT_TRUE(tls_faults(pem, now_s).empty());
    EXPECT_THAT(pem.key, HasSubstr("BEGIN PRIVATE KEY"));
    std::string fault;
    const auto identity = make_identity(pem, true, fault);
    ASSERT_TRUE(identity) << fault;
    EXPECT_TRUE(identity->self_made);
    EXPECT_NE(made().certificate, pem.certificate);
    EXPECT_NE(made().key, pem.key);
}

TEST(Tls, MadeCertificateHoldsForItsDaysAndIsRenewedBefore) {
    const auto pem = made();
    const struct {
        std::int64_t day;
        bool holds, stays;
    } table[] = {{-1, false, false},
                 {0, true, true},
                 {self_made_days - renew_days - 1, true, true},
                 {self_made_days - renew_days + 1, true, false},
                 {self_made_days - 1, true, false},
                 {self_made_days + 1, false, false}};
    for (const auto& t : table) {
        const auto at = now_s + t.day * day_s;
        EXPECT_EQ(tls_faults(pem, at).empty(), t.holds) << "day " << t.day;
        EXPECT_EQ(still_good(pem, names, at), t.stays) << "day " << t.day;
    }
}

TEST(Tls, EachNameIsInTheCertificate) {
    const auto pem = made();
    for (const auto& name : names)
        EXPECT_TRUE(still_good(pem, std::vector{name}, now_s)) << name;
    for (const char* other : {"192.0.2.8", "::2", "other.plant.example"})
        EXPECT_FALSE(still_good(pem, std::vector<std::string>{other}, now_s)) << other;
}

TEST(Tls, HostileNamesAreLeftOut) {
    const std::vector<std::string> hostile{"localhost", "a,DNS:bank.example", "", "a b", std::string(300, 'a')};
    const auto pem = make_self_signed(hostile, now_s);
    ASSERT_TRUE(pem);
    EXPECT_TRUE(still_good(*pem, hostile, now_s)) << "else it would be made anew at each start";
    EXPECT_FALSE(still_good(*pem, std::vector<std::string>{"bank.example"}, now_s));
}

TEST(Tls, FaultsAreTold) {
    const auto one = made(), two = made();
    const struct {
        TlsPem pem;
        std::int64_t at;
        TlsFault::In in;
        const char* words;
    } table[] = {
        {{"", one.key}, now_s, TlsFault::In::certificate, "not a certificate"},
        {{one.key, one.key}, now_s, TlsFault::In::certificate, "not a certificate"},
        {{one.certificate, ""}, now_s, TlsFault::In::key, "not a private key"},
        {{one.certificate, one.certificate}, now_s, TlsFault::In::key, "not a private key"},
        {{one.certificate.substr(0, 200), one.key}, now_s, TlsFault::In::certificate, "not a certificate"},
        {{one.certificate, two.key}, now_s, TlsFault::In::key, "does not belong"},
        {one, now_s + 900 * day_s, TlsFault::In::certificate, "expired on 20"},
        {one, now_s - day_s, TlsFault::In::certificate, "holds only from"},
    };
    for (const auto& t : table) {
        const auto faults = tls_faults(t.pem, t.at);
        ASSERT_EQ(faults.size(), 1U) << t.words;
        EXPECT_EQ(faults[0].in, t.in) << t.words;
        EXPECT_THAT(faults[0].text, HasSubstr(t.words));
        EXPECT_FALSE(faults[0].remedy.empty());
    }
}
}  // namespace
}  // namespace axisgate::http::test
