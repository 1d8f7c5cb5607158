// A small HTTP server for the conditions of drives that run by themselves (`axisgate twin --hand`): GET /hand, PATCH or PUT /hand with
// {"name": value, ...}; /hand/{address} if there are several drives. Every answer has all conditions as JSON. Bounded: 16 connections, 64
// KiB per body, 10 s per request.
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
        /// Empty if all were set, otherwise the fault.
        std::function<std::string(const std::vector<std::pair<std::string, Value>>&)> set;
    };
    HandServer(boost::asio::io_context& io, std::string bind, std::vector<Drive> drives);
    ~HandServer();
    /// Empty if it listens, otherwise the fault and the remedy.
    [[nodiscard]] std::string open();
    /// "127.0.0.1:9100", with the actual port.
    [[nodiscard]] std::string address() const;

private:
    struct Parts;
    std::shared_ptr<Parts> parts_;
};

}  // namespace axisgate::http
