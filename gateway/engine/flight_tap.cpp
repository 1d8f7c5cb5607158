// FlightTap turns the engine's calls into records; FlightLog stores records in chunks, which do not change when they are shared. The log
// never exceeds its bound by more than one chunk.
#include <algorithm>

#include "gateway/engine/flight_codec.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {
using namespace flight;  // this file is a part of the codec

// --- the tap --------------------------------------------------------------------------------------------------------

void FlightTap::command(const Command& c, Instant now) {
    scratch_.clear();
    Packer p{scratch_};
    io_all(p, c.ticket, c.axis, c.until_done, c.origin);
    io_variant(p, c.body, [&](auto& b) { io_body(p, b); });
    give(FlightKind::command, index_of(c.axis), now);
}
void FlightTap::set_point(const SetPoint& p, Instant now) {
    pack(scratch_, SetPointRecord{p});
    give(FlightKind::set_point, index_of(p.axis), now);
}
void FlightTap::client_lost(const AuthorityClient& who, LossCause cause, Instant now) {
    pack(scratch_, LossRecord{who, cause});
    give(FlightKind::client_lost, 0xFFFF, now);
}
void FlightTap::stored(Ticket order, const std::string& fault, Instant now) {
    pack(scratch_, StoredRecord{order, fault});
    give(FlightKind::stored, 0xFFFF, now);
}
void FlightTap::look(const LookRecord& look, Instant now) {
    pack(scratch_, look);
    give(FlightKind::look, 0xFFFF, now);
}
void FlightTap::scan(LineId line, const ScanWish& wish, Instant now) {
    pack(scratch_, wish);
    give(FlightKind::scan, index_of(line), now);
}
void FlightTap::hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now) {
    pack(scratch_, HandRecord{items, origin});
    give(FlightKind::hand, index_of(drive), now);
}
void FlightTap::adopt(DriveId drive, const NonVolatile& memory, const Origin& origin, Instant now) {
    pack(scratch_, HandRecord{{memory.begin(), memory.end()}, origin});
    give(FlightKind::twin_memory, index_of(drive), now);
}
void FlightTap::line_state(LineId line, bool up, const std::string& why, Instant now) {
    pack(scratch_, LineStateRecord{up, why});
    give(FlightKind::line_state, place_of(line), now);
}
void FlightTap::last_received(std::optional<Instant> at, Instant now) {
    pack(scratch_, at ? ns_of(*at) : std::int64_t{-1});
    give(FlightKind::last_received, 0xFFFF, now);
}
void FlightTap::send_refused(LineId line, Instant now) {
    const std::size_t i = index_of(line);
    pack(scratch_, static_cast<std::int64_t>(i < handed_.size() ? handed_[i] : 0));
    give(FlightKind::send_refused, index_of(line), now);
}

void FlightTap::frame(LineId line, const Frame& f, bool to_drive, bool twin) {
    FrameRecord r;
    r.to_drive = to_drive;
    if (to_drive && !waiting_.empty()) {
        const auto it = std::ranges::find_if(waiting_, [&](const Waiting& w) { return w.line == line && w.frame.same(f); });
        if (it != waiting_.end()) {
            r.cause = it->cause;
            waiting_.erase(it);
        }
    }
    r.frame = f;
    pack(scratch_, r);
    if (twin) return give(FlightKind::twin_frame, index_of(line), f.at);
    give(to_drive ? FlightKind::sent : FlightKind::received, place_of(line), f.at);
}
void FlightTap::handed(LineId line, const Frame& f, bool twin, Ticket command, Instant now) {
    const Ticket cause = command != no_ticket ? command : cause_;
    if (cause != no_ticket) {
        if (waiting_.size() >= most_waiting) waiting_.erase(waiting_.begin());
        waiting_.push_back({line, cause, f});
    }
    if (twin) return;
    if (handed_.size() <= index_of(line)) handed_.resize(index_of(line) + 1u);
    ++handed_[index_of(line)];
    FrameRecord r;
    r.to_drive = true;
    r.cause = cause;
    r.frame = f;
    pack(scratch_, r);
    give(FlightKind::handed, index_of(line), now);
}
void FlightTap::picture(AxisId axis, const AxisPicture& p, Instant now) {
    pack(scratch_, picture_record(p, now));
    give(FlightKind::picture, index_of(axis), now);
}
void FlightTap::result(const Result& r, Instant now) {
    pack(scratch_, r);
    give(FlightKind::result, index_of(r.axis), now);
}
void FlightTap::event(const Event& e, Instant now) {
    pack(scratch_, e);
    give(FlightKind::event, 0xFFFF, now);
}
void FlightTap::sample(const Sample& s, Instant now) {
    pack(scratch_, s);
    give(FlightKind::sample, index_of(s.axis), now);
}

// --- records in a row -----------------------------------------------------------------------------------------------

namespace {
constexpr char absolute_mark = 0;  // replaces the kind; the instant that follows is absolute
}

void FlightLog::add(const FlightRecord& r) {
    if (overflowed_ && !keep_newest_) return void(++gone_);
    if (!open_ || open_->bytes.size() + r.payload.size() + 32 > chunk_bytes) {
        if (open_) whole_.push_back(std::move(open_));
        open_ = std::make_shared<Chunk>();
        open_->bytes.reserve(std::max(chunk_bytes, r.payload.size() + 64));
        open_->first = r.at;
        open_->bytes.push_back(absolute_mark);
        put_number(open_->bytes, zigzag(ns_of(r.at)));
        bytes_ += open_->bytes.size();
        last_ = r.at;
    }
    std::string& out = open_->bytes;
    const std::size_t before = out.size();
    out.push_back(static_cast<char>(r.kind));
    put_number(out, zigzag((r.at - last_).count()));
    put_number(out, static_cast<std::uint16_t>(r.index + 1));
    put_number(out, r.payload.size());
    out.append(r.payload.data(), r.payload.size());
    bytes_ += out.size() - before;
    last_ = open_->last = r.at;
    ++open_->records;
    if (!is_input(r.kind)) ++open_->outcomes;
    if (bytes_ <= bound_) return;
    if (!keep_newest_) return give_up();
    while (bytes_ > bound_ && !whole_.empty()) {
        bytes_ -= whole_.front()->bytes.size();
        gone_ += whole_.front()->records;
        gone_outcomes_ += whole_.front()->outcomes;
        whole_.erase(whole_.begin());
    }
}

void FlightLog::give_up() noexcept {
    overflowed_ = true;
    for (const auto& c : whole_)
        gone_ += c->records;
    if (open_) gone_ += open_->records;
    whole_.clear();
    open_.reset();
    bytes_ = 0;
}

FlightLog::Chunks FlightLog::chunks() const {
    Chunks all = whole_;
    if (open_) all.push_back(std::make_shared<const Chunk>(*open_));  // the last chunk is still being written
    return all;
}

std::optional<FlightRecord> FlightReader::next() {
    const auto broken = [this]() -> std::optional<FlightRecord> {
        damaged_ = true;
        rest_ = {};
        return std::nullopt;
    };
    std::uint64_t raw = 0;
    while (!rest_.empty() && rest_.front() == absolute_mark) {
        rest_ = rest_.subspan(1);
        if (!take_number(rest_, raw)) return broken();
        last_ = at_ns(unzigzag(raw));
    }
    if (rest_.empty()) return std::nullopt;
    FlightRecord r;
    r.kind = static_cast<FlightKind>(rest_.front());
    if (name_of(r.kind) == "unknown") return broken();
    rest_ = rest_.subspan(1);
    if (!take_number(rest_, raw)) return broken();
    last_ = r.at = at_ns(static_cast<std::int64_t>(static_cast<std::uint64_t>(ns_of(last_)) + static_cast<std::uint64_t>(unzigzag(raw))));
    std::uint64_t size = 0;
    if (!take_number(rest_, raw) || raw > 0xFFFF || !take_number(rest_, size) || size > rest_.size()) return broken();
    r.index = static_cast<std::uint16_t>(raw - 1);
    r.payload = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return r;
}

}  // namespace axisgate
