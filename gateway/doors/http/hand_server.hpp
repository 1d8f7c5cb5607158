// HandServer: the tester's hand of drives that run by themselves (`axisgate twin --hand`): a small HTTP server for it alone.
// In: GET /hand, PATCH or PUT /hand with {"name": value, ...}; /hand/{address} where there are several drives. Out: all items as JSON.
// Bounded: 16 connections, 64 KiB per body, 10 s per request. Never listens on anything but what it is given.
#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway/core/twin.hpp"

namespace axisgate::http {

class HandServer {
public:
    struct Drive {
        std::string address;
        std::function<std::vector<HandItem>()> items;
        /// Empty: all were set; else what is wrong.
        std::function<std::string(const std::vector<std::pair<std::string, Value>>&)> set;
    };
    HandServer(boost::asio::io_context& io, std::string bind, std::vector<Drive> drives);
    ~HandServer();
    /// Empty: it listens; else what is wrong and what to do.
    [[nodiscard]] std::string open();
    /// "127.0.0.1:9100", with the port that was really taken.
    [[nodiscard]] std::string address() const;

private:
    struct Parts;
    std::shared_ptr<Parts> parts_;
};

}  // namespace axisgate::http
