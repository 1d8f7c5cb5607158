// Fuzz target for an EtherNet/IP device with a peer that sends anything, on TCP and both UDP ports, at any time. Laws: bounds hold, time
// advances, an owner of an output is informed of its end once, and a correct client is served afterwards.
#include "gateway/protocols/cip/adapter.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using namespace axisgate::cip;
using fuzz::require;

namespace {
struct Device1 final : Values, Output {
    Device1() {
        device_.name = "axisgate";
        device_.address = 0x7F000001;
        device_.mask = 0xFF000000;
        parameter_.name = "p";
        parameter_.writable = true;
        parameter_.min = parameter_.max = parameter_.fallback = Bytes(4);
    }
    const Device& device() const override { return device_; }
    std::optional<AssemblyInfo> assembly(std::uint32_t i) const override {
        using Role = AssemblyInfo::Role;
        if (i == 101) return AssemblyInfo{Role::input, 8};
        if (i == 151) return AssemblyInfo{Role::output, 8};
        if (i == 197) return AssemblyInfo{Role::listen_only, 0};
        if (i == 198) return AssemblyInfo{Role::input_only, 0};
        return i == 199 ? std::optional(AssemblyInfo{Role::configuration, 0}) : std::nullopt;
    }
    const std::vector<std::uint32_t>& assemblies() const override { return list_; }
    void read(std::uint32_t, Instant, Bytes& to) override { to.insert(to.end(), 8, 0); }
    std::uint64_t revision(std::uint32_t) const override { return 0; }
    General write(std::uint32_t, View data, Token, const Peer&, Instant, bool&) override {
        require(data.size() == 8, "an output is written whole");
        return General::success;
    }
    bool overlap(std::uint32_t a, std::uint32_t b) const override { return a == b; }
    bool held_by_another(std::uint32_t, const Peer&, Instant) const override { return false; }
    void opened(std::uint32_t, const Peer&, Duration, Instant) override { require(++owners_ == 1, "one owner at a time"); }
    void consumed(std::uint32_t, View data, const Peer&, Instant) override {
        require(owners_ == 1 && data.size() == 8, "data come from the owner and have their size");
    }
    void idle(std::uint32_t, const Peer&, Instant) override { require(owners_ == 1, "only an owner falls to idle"); }
    void ended(std::uint32_t, const Peer&, End, Instant) override { require(--owners_ == 0, "an owner ends once"); }
    std::uint32_t parameters() const override { return 1; }
    std::optional<ParameterInfo> parameter(std::uint32_t) const override { return parameter_; }
    General ask(std::uint32_t, Token t, const Peer&, Instant) override {
        asked_.push_back(t);
        return t == 0 ? General::resource_unavailable : General::success;
    }
    General set(std::uint32_t, View v, Token t, const Peer&, Instant) override {
        require(v.size() == 4, "a value has its size");
        asked_.push_back(t);
        return General::success;
    }
    bool has_own_class(std::uint32_t c) const override { return c == 0x66; }
    std::optional<OwnAttribute> own_attribute(std::uint32_t c, std::uint32_t i, std::uint32_t a) const override {
        return c == 0x66 && i == 1 && a <= 2 ? std::optional(OwnAttribute{DataType::dint, a != 2, true}) : std::nullopt;
    }
    General get_own(const OwnPlace& place, Instant, Bytes& to) override {
        require(place.class_id == 0x66 && place.instance == 1 && place.attribute == 1, "only what can be read is read");
        put32(to, 7);
        return General::success;
    }
    General set_own(const OwnPlace& place, View v, Token t, const Peer&, Instant, bool& later) override {
        require(place.attribute >= 1 && place.attribute <= 2 && v.size() == 4 && t != 0, "a value has its size and its place");
        later = place.attribute == 2;
        if (later) asked_.push_back(t);
        return General::success;
    }
    void implicit(Endpoint, View d, std::uint8_t) override { require(read_implicit(d).has_value(), "what is sent can be read"); }
    void stream(SessionKey, View d) override {
        require(d.size() >= header_size && read_header(d).length == d.size() - header_size, "a packet has its length");
        last_.assign(d.begin(), d.end());
    }
    void datagram(Endpoint, View) override {}
    void hang_up(SessionKey key) override { gone_.push_back(key); }

    Device device_;
    ParameterInfo parameter_;
    std::vector<std::uint32_t> list_{101, 151, 197, 198, 199};
    std::vector<Token> asked_;
    std::vector<SessionKey> gone_;
    Bytes last_;
    int owners_ = 0;
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider in(data, size);
    Device1 d;
    cip::Adapter adapter(d, d, 1);
    Instant now = at_ns(1);
    SessionKey key = 1;
    const Endpoint from{0x7F000001, 1};
    std::uint32_t handle = 0;
    const auto connect = [&] {
        require(adapter.on_connected(key, from, now), "there is room for one more");
        Header h;
        h.command = 0x65;
        adapter.on_stream(key, packet(h, Bytes{1, 0, 0, 0}), now);
        handle = read_header(d.last_).session;
    };
    connect();
    for (int step = 0; step < 64 && in.remaining_bytes() > 0; ++step) {
        const int kind = in.ConsumeIntegralInRange<int>(0, 6);
        const auto bytes = in.ConsumeBytes<std::uint8_t>(in.ConsumeIntegralInRange<std::size_t>(0, 200));
        Header h;
        h.session = handle;
        if (kind == 0) {
            adapter.on_stream(key, bytes, now);
        } else if (kind <= 2) {
            h.command = 0x6F;
            Bytes body(6);
            put16(body, 2);
            put_item(body, item::null_address, {});
            put_item(body, item::unconnected_data, bytes);
            adapter.on_stream(key, packet(h, body), now);
        } else if (kind == 3) {
            adapter.on_datagram(bytes, from, in.ConsumeBool(), now);
        } else if (kind == 4) {
            adapter.on_implicit(bytes, from, now);
        } else if (kind == 5) {
            for (const Token t : std::exchange(d.asked_, {}))
                adapter.answered(t, General::success, Bytes(4));
        } else {
            now += fuzz::any_step(in);
            adapter.on_deadline(now);
            require(adapter.deadline() > now, "time goes on");
        }
        for (const SessionKey gone : std::exchange(d.gone_, {})) {
            adapter.on_disconnected(gone);
            if (gone == key) {
                ++key;
                connect();
            }
        }
        require(adapter.sessions() <= cip::Adapter::most_sessions, "sessions are bounded");
    }
    adapter.on_disconnected(key++);
    connect();
    require(handle != 0, "an honest client is served");
    return 0;
}
