// Fuzz target: one Modbus/TCP client that sends anything, in pieces of any size, while results come, time passes and axes change. The
// program is aborted when an answer is missing, unexpected, out of order or malformed.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "gateway/core/assets.hpp"
#include "gateway/doors/modbus/session.hpp"
#include "gateway/registers/profiles/profile_map.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace {
using namespace axisgate;
using namespace axisgate::modbus;
using namespace axisgate::registers;

void require(bool holds) {
    if (!holds) std::abort();
}

const std::shared_ptr<const Language>& page(ProfileLanguage language) {
    static const Languages all = [] {
        Languages pages;
        for (std::size_t i = 0; i < pages.size(); ++i) {
            std::string fault;
            pages[i] = read_language(asset("schema/profiles/" + std::string(name_of(static_cast<ProfileLanguage>(i))) + ".json"), fault);
            require(pages[i] != nullptr);
        }
        return pages;
    }();
    return all[static_cast<std::size_t>(language)];
}

struct Script {
    std::span<const std::uint8_t> data;
    std::uint8_t byte() {
        if (data.empty()) return 0;
        const std::uint8_t b = data[0];
        data = data.subspan(1);
        return b;
    }
    std::span<const std::uint8_t> take(std::size_t n) {
        n = std::min(n, data.size());
        const auto s = data.first(n);
        data = data.subspan(n);
        return s;
    }
};

struct World : SessionWaker {
    explicit World(WordOrder order) : door(port, order) {
        for (std::uint16_t n = 1; n <= 3; ++n)
            axes.push_back(port.add_axis(n, &test::catalogue()));
        // Units 10 to 12 have other devices' languages.
        for (const auto language : {ProfileLanguage::lexium, ProfileLanguage::pacontrol, ProfileLanguage::linmot}) {
            ProfileMap::Setup setup{page(language), order, {}, MapGaps::zero};
            for (std::size_t i = 0; i < std::min(most_axes(language), axes.size()); ++i) {
                setup.axes.emplace_back();
                setup.axes.back().id = axes[i];
                setup.axes.back().name = "a";
                setup.axes.back().increments_per_count = 0.37;
            }
            profiles.push_back(make_profile(language, port, std::move(setup)));
            door.image.set_map(static_cast<std::uint8_t>(9 + profiles.size()), profiles.back().get());
        }
    }
    void wake(Session&) override {}

    /// The expected answers, from the client's own bytes: the head of every whole request before the first bad header.
    void sent(std::span<const std::uint8_t> bytes) {
        stream.insert(stream.end(), bytes.begin(), bytes.end());
        while (!worthless && stream.size() >= 6) {
            const std::size_t length = std::size_t{stream[4]} * 256 + stream[5];
            if (stream[2] != 0 || stream[3] != 0 || length < 2 || length > 254) {
                worthless = true;
            } else if (stream.size() >= 6 + length) {
                expected.push_back({stream[0], stream[1], stream[6], stream[7]});
                stream.erase(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(6 + length));
            } else {
                break;
            }
        }
    }
    void work() {
        do {
            out->size = 0;
            last = session.work(port.now(), *out);
            std::span<const std::uint8_t> answers(out->bytes.data(), out->size);
            while (!answers.empty()) {
                require(answers.size() >= 9 && !expected.empty());
                const auto request = expected.front();
                expected.pop_front();
                const std::size_t length = std::size_t{answers[4]} * 256 + answers[5];
                require(answers[0] == request[0] && answers[1] == request[1] && answers[6] == request[2]);
                require(answers[2] == 0 && answers[3] == 0 && length >= 3 && length <= 254 && answers.size() >= 6 + length);
                require((answers[7] & 0x7F) == (request[3] & 0x7F));
                if (answers[7] != request[3] || request[3] >= 0x80) require(length == 3 && answers[8] >= 1 && answers[8] <= 0x0B);
                answers = answers.subspan(6 + length);
            }
        } while (last == Session::Work::output_full);
        require(session.in_flight() <= Session::max_in_flight &&
                port.commands.size() <= 4096);  // commands of profiles do not delay their client
    }

    test::FakePort port;
    test::ResponderDoor door;
    Responder& responder = door.responder;
    Session session{responder, *this, nullptr};
    std::unique_ptr<AnswerBuffer> out = std::make_unique<AnswerBuffer>();
    std::vector<AxisId> axes;
    std::vector<std::unique_ptr<ProfileMap>> profiles;
    Session::Work last = Session::Work::need_bytes;
    std::vector<std::uint8_t> stream;
    bool worthless = false;
    std::deque<std::array<std::uint8_t, 4>> expected;
};
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Script script{{data, size}};
    World world(script.byte() % 2 == 0 ? WordOrder::high_first : WordOrder::low_first);
    while (!script.data.empty() && world.last != Session::Work::not_modbus) {
        const std::uint8_t op = script.byte();
        switch (op % 8) {
            case 0:
                world.port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{script.byte()} - 100});
                break;
            case 1:
                world.port.refuse(static_cast<Reason>(script.byte() % 14), script.byte());
                break;
            case 2:
                world.port.time += std::chrono::seconds(script.byte());
                world.responder.writer().sweep(world.port.time);
                break;
            case 3:
                if (op & 0x80) {
                    world.port.remove_axis(static_cast<std::uint16_t>(1 + op / 8 % 3));
                } else {
                    world.axes.push_back(world.port.add_axis(static_cast<std::uint16_t>(1 + op / 8 % 3), &test::catalogue()));
                }
                break;
            case 4:
                world.port.edit(world.axes.back(), [&](AxisPicture& p) {
                    p.position = script.byte() * 0x01020304LL;
                    p.statusword = script.byte();
                    p.flags = script.byte();
                });
                break;
            case 5: {  // a whole ADU, so that the fuzzer gets past the header
                std::uint8_t adu[7 + 253] = {0, op, 0, 0, 0, 0, static_cast<std::uint8_t>(op & 0x80 ? script.byte() : 1)};
                const auto pdu = script.take(1 + script.byte() % 253);
                std::copy(pdu.begin(), pdu.end(), adu + 7);
                adu[5] = static_cast<std::uint8_t>(1 + pdu.size());
                const auto whole = std::span(adu).first(7 + pdu.size());
                if (world.session.input().space().size() >= whole.size()) {
                    (void)world.session.input().feed(whole);
                    world.sent(whole);
                }
                break;
            }
            default: {
                const auto bytes = script.take(1 + op / 8);
                const std::size_t n = world.session.input().feed(bytes);
                world.sent(bytes.first(n));
            }
        }
        world.work();
        if (world.axes.size() > 64) break;
    }
    // Every request gets its answer when every command has its result.
    while (world.port.answer())
        world.work();
    world.work();
    require(world.expected.empty());
    require(world.worthless == (world.last == Session::Work::not_modbus) || world.last == Session::Work::not_modbus);
    require(world.responder.writer().waiting() == 0);
    return 0;
}
