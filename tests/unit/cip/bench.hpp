// A device with two axes' assemblies and some parameters, and an originator for its adapter, without sockets. The test provides the time.
#pragma once

#include <map>
#include <string>

#include "gateway/protocols/cip/adapter.hpp"
#include "tests/unit/cip/witness.hpp"

namespace axisgate::cip::bench {

inline Bytes hex(std::string_view text) {
    Bytes out;
    int high = -1;
    for (const char c : text) {
        const int v = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
        if (v < 0) continue;
        if (high < 0) {
            high = v;
        } else {
            out.push_back(static_cast<std::uint8_t>(high << 4 | v));
            high = -1;
        }
    }
    return out;
}

/// In addition to 103 and 153, whose size is 0: inputs 101, 102 and 100 (both), outputs 151, 152 and 150 (both), configuration 199,
/// heartbeats 198 and 197; parameters 1..4.
struct TestValues final : Values {
    TestValues();
    [[nodiscard]] const Device& device() const override { return device_; }
    [[nodiscard]] std::optional<AssemblyInfo> assembly(std::uint32_t instance) const override;
    [[nodiscard]] const std::vector<std::uint32_t>& assemblies() const override { return list_; }
    void read(std::uint32_t instance, Instant now, Bytes& to) override;
    [[nodiscard]] std::uint64_t revision(std::uint32_t) const override { return changes; }
    [[nodiscard]] General write(std::uint32_t instance, View data, Token token, const Peer& who, Instant now, bool& later) override;
    void messages_ended(const Peer& way) override;
    [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) const override { return a == b || a == 150 || b == 150; }
    [[nodiscard]] bool held_by_another(std::uint32_t, const Peer&, Instant) const override { return held; }
    void opened(std::uint32_t output, const Peer& who, Duration time_out, Instant now) override;
    void consumed(std::uint32_t output, View data, const Peer& who, Instant now) override;
    void idle(std::uint32_t output, const Peer& who, Instant now) override;
    void ended(std::uint32_t output, const Peer& who, End why, Instant now) override;
    [[nodiscard]] std::uint32_t parameters() const override { return 4; }
    [[nodiscard]] std::optional<ParameterInfo> parameter(std::uint32_t instance) const override { return parameters_.at(instance - 1); }
    [[nodiscard]] General ask(std::uint32_t instance, Token token, const Peer& who, Instant now) override;
    [[nodiscard]] General set(std::uint32_t instance, View value, Token token, const Peer& who, Instant now) override;

    Device device_;
    bool held = false;
    std::uint64_t changes = 1;
    std::uint8_t shown = 0x11;          ///< every byte of the inputs
    std::vector<std::string> reported;  ///< "opened 151", "consumed 151 01 02 ..", "idle 151", "ended 151 closed"
    std::vector<Token> asked;
    Bytes set_to;
    bool writes_later = false;  ///< a write of an output is answered by the test

private:
    std::vector<std::uint32_t> list_{100, 101, 102, 150, 151, 152, 197, 198, 199};
    std::vector<ParameterInfo> parameters_;
};

struct TestOutput final : Output {
    void implicit(Endpoint to, View datagram, std::uint8_t dscp) override;
    void stream(SessionKey session, View bytes) override;
    void datagram(Endpoint to, View bytes) override;
    void hang_up(SessionKey session) override { hung_up.push_back(session); }

    struct Datagram {
        Endpoint to;
        Bytes bytes;
        std::uint8_t dscp = 0;
    };
    Witness witness;
    std::map<SessionKey, Bytes> streams;
    std::vector<Datagram> datagrams, implicits;
    std::vector<SessionKey> hung_up;
};

/// The content of a Forward_Open; the defaults are an exclusive owner of axis 1 at 10 ms, time-out 40 ms.
struct Open {
    std::uint16_t serial = 1, vendor = 0x1234;
    std::uint32_t originator = 77, to_id = 0x5000;
    std::uint8_t multiplier = 0, transport = 0x01;
    bool redundant = false;  ///< owner
    std::uint32_t ot_rpi = 10'000, to_rpi = 10'000;
    std::uint32_t ot_size = 38, to_size = 34, ot_type = 2, to_type = 2;
    bool variable = false, large = false;
    std::string path = "20 04 24 C7 2C 97 2C 65";
    std::uint8_t path_words = 0;  ///< 0: as many as there are
    [[nodiscard]] Bytes message() const;
    [[nodiscard]] Bytes close() const;
};

class Bench {
public:
    static constexpr Endpoint plc{0xC0A80001, 50'000}, other{0xC0A80002, 50'001};
    Bench();
    void connect(SessionKey key, Endpoint from = plc);
    /// A whole packet; the answer's bytes, or none.
    Bytes packet_of(SessionKey key, std::uint16_t command, View data, std::uint32_t options = 0);
    void register_session(SessionKey key);
    /// An unconnected message and its answer. `items` are further ones of the request.
    Answer ask(View message, SessionKey key = 1);
    Answer open(const Open& o, SessionKey key = 1) { return ask(o.message(), key); }
    /// O->T id of a good answer.
    std::uint32_t opened(const Open& o, SessionKey key = 1);
    void implicit(std::uint32_t id, std::uint32_t sequence, std::uint16_t count, std::string_view data, Endpoint from = plc);
    void pass(Duration d);
    /// The last packet's status, and its common packet format without interface and time-out.
    PacketStatus status = PacketStatus::success;
    Bytes items;

    TestValues values;
    TestOutput output;
    Adapter adapter;
    Instant now = at_ns(1'000'000'000);
    std::map<SessionKey, std::uint32_t> handles;
};

Bytes get(std::uint32_t class_id, std::uint32_t instance, std::uint32_t attribute, std::uint8_t service = service::get_single,
          View data = {});

}  // namespace axisgate::cip::bench
