// The named clients that have recently sent a request, as candidates for a hand-over of an axis. Bounded: a new client replaces the one
// with the oldest request. It does not decide who may command; the lease does.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

class ClientsSeen {
public:
    static constexpr std::size_t most = 64;
    static constexpr std::int64_t forget_after_ns = 600'000'000'000;

    struct Client {
        std::string name;  ///< as in AuthorityClient: user or host, then the name that the client gives itself
        std::int64_t at_unix_ns = 0;
    };
    void note(std::string_view name, std::int64_t now_unix_ns);
    [[nodiscard]] std::vector<Client> list(std::int64_t now_unix_ns) const;

private:
    std::vector<Client> clients_;
};

}  // namespace axisgate
