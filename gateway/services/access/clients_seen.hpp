// ClientsSeen: which clients with a name of their own have lately asked a door for anything: to whom an axis can be handed over.
// In: names with the moment. Out: a list, newest first. Bounded: the one that was seen longest ago makes room.
// Never says who may command: that is the lease's business.
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
        std::string name;  ///< as AuthorityClient has it: user or host, then the name that it gives itself
        std::int64_t at_unix_ns = 0;
    };
    void note(std::string_view name, std::int64_t now_unix_ns);
    [[nodiscard]] std::vector<Client> list(std::int64_t now_unix_ns) const;

private:
    std::vector<Client> clients_;
};

}  // namespace axisgate
