// The removed parts of texts that leave the machine, and the parts that stay readable.
#include <gtest/gtest.h>

#include "gateway/runtime/scrub.hpp"

namespace axisgate::scrub_test {

TEST(Scrub, SecretsAreTakenOutWhateverTheirForm) {
    const std::string key = "dGhpcyBpcyBhIHNlY3JldCB0aGF0IGlzIGxvbmdlciB0aGFuIGZvcnR5";
    const std::string hex = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";
    const struct {
        std::string given, expected;
    } cases[] = {
        {"password = \"a long \\\" sentence\"\nnext = 1", "password = \"(removed)\"\nnext = 1"},
        {R"x({"user":"anna","password":"x, y","role":"viewer"})x", R"x({"user":"anna","password":"(removed)","role":"viewer"})x"},
        {R"x({"token_count": 3, "a": 1})x", R"x({"token_count": "(removed)", "a": 1})x"},
        {"db_passphrase='abc'", "db_passphrase='(removed)'"},
        {"--set x.secret=abc other", "--set x.secret=(removed) other"},
        {"Authorization: Bearer abc.def\nHost: h", "Authorization: (removed)\nHost: h"},
        {"Cookie: axisgate_session_1=abc; b=c", "Cookie: (removed); b=c"},
        {"GET /x?token=abc&y=1", "GET /x?token=(removed)&y=1"},
        {"http://anna:geheim@host/x", "http://(removed)@host/x"},
        {"first sign-in: code K7QF-2M9D-XW3E-8HTR (shown once)", "first sign-in: code (removed) (shown once)"},
        {"-----BEGIN PRIVATE KEY-----\nabc\n-----END PRIVATE KEY-----\nafter", "(removed)\nafter"},
        {"-----BEGIN PRIVATE KEY-----\nabc without an end", "(removed)"},
        {"it is " + key + ".", "it is (removed)."},
        {"digest " + hex, "digest (removed)"},
    };
    for (const auto& c : cases) {
        EXPECT_EQ(scrub(c.given), c.expected);
        EXPECT_EQ(scrub(scrub(c.given)), scrub(c.given)) << "a second time changes nothing";
    }
}

TEST(Scrub, WhatHelpsStaysReadable) {
    for (const std::string text :
         {"[http]\nbind = \"127.0.0.1:8080\"\ntls_key = \"/etc/axisgate/key.pem\"\n[users]\nsession_idle_min = 60\nsession_max_h = 12\n",
          "axisgate_modbus_rtu_request_duration_seconds_bucket{le=\"0.0005\"} 12\n",
          "2026-01-02T03:04:05.678901+0000 info line line=can0: up at 1000000 bit/s",
          R"({"lines":[{"name":"can0","uri":"serial:/dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A50285BI-if00-port0?baud=9600"}]})",
          "tcp://192.0.2.7:502/x and a@b", "drive feeder: 4D8-1A2B", "", "="})
        EXPECT_EQ(scrub(text), text);
}

TEST(Scrub, AnyTextHasAnEnd) {
    for (const std::string text :
         {"password", "password=", "password:\"", "password:'\\", "://", "-----BEGIN ", "token = \n", "\"secret\"", "\"secret\":"})
        (void)scrub(text);
    std::string all;
    for (int i = 0; i < 256; ++i)
        all += static_cast<char>(i);
    EXPECT_EQ(scrub(all).size(), all.size());
}

}  // namespace axisgate::scrub_test
