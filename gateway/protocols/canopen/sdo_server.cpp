// SdoServer: one transfer, driven by the client's requests.
// A request that begins a new transfer ends the present one, except within a block, where it cannot be distinguished from a segment.
#include "gateway/protocols/canopen/sdo_server.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace axisgate::canopen {

void SdoServer::set_node(std::uint8_t node) noexcept {
    request_id_ = std::uint32_t{sdo_request_base} + node;
    answer_id_ = std::uint32_t{sdo_answer_base} + node;
    phase_ = Phase::idle;
}

void SdoServer::abort(Abort why, std::vector<Frame>& out) {
    out.push_back(abort_frame(answer_id_, address_, why));
    phase_ = Phase::idle;
}
void SdoServer::on_deadline(Instant now, std::vector<Frame>& out) {
    if (busy() && now >= deadline_) abort(Abort::timeout, out);
}

bool SdoServer::on_frame(const Frame& f, Instant now, std::vector<Frame>& out) {
    if (!is_data(f, request_id_)) return false;
    if (f.size != 8) return true;
    deadline_ = now + limits_.patience;
    const std::uint8_t b = f.storage[0];
    if (b == 0x80) {
        phase_ = Phase::idle;
        return true;
    }
    if (phase_ == Phase::block_write) {
        on_block_write(f, out);
        return true;
    }
    const unsigned command = b >> 5;
    if (command == 1 || command == 2 || (command == 5 && (b & 3u) == 0) || (command == 6 && (b & 1u) == 0)) {
        begin(f, out);
        return true;
    }
    switch (phase_) {
        case Phase::read:
            on_read(f, out);
            break;
        case Phase::write:
            on_write(f, out);
            break;
        case Phase::block_read_begin:
        case Phase::block_read:
        case Phase::block_read_end:
            on_block_read(f, out);
            break;
        case Phase::block_write_end:
            on_block_write_end(f, out);
            break;
        default:
            address_ = {};
            abort(Abort::command, out);
    }
    return true;
}

void SdoServer::begin(const Frame& f, std::vector<Frame>& out) {
    phase_ = Phase::idle;
    address_ = address_of(f);
    toggle_ = false;
    at_ = 0;
    data_.clear();
    announced_.reset();
    switch (f.storage[0] >> 5) {
        case 1:
            begin_write(f, out);
            return;
        case 2:
            begin_read(f, false, out);
            return;
        case 5:
            begin_read(f, true, out);
            return;
        default:
            begin_block_write(f, out);
    }
}

void SdoServer::begin_read(const Frame& f, bool block, std::vector<Frame>& out) {
    client_crc_ = (f.storage[0] & 4u) != 0;
    block_size_ = f.storage[4];
    if (block && (block_size_ == 0 || block_size_ > most_block_size)) return abort(Abort::block_size, out);
    const Abort fault = store_.read(address_, data_);
    if (fault != Abort::none) return abort(fault, out);
    const auto size = static_cast<std::uint32_t>(data_.size());
    // A client may give a size up to which it accepts the plain protocol.
    if (block && size > f.storage[5]) {
        sender_.begin(std::move(data_), limits_.stalls);
        out.push_back(sdo_frame(answer_id_, 0xC6, address_, size));
        phase_ = Phase::block_read_begin;
    } else if (size >= 1 && size <= 4) {
        out.push_back(sdo_frame(answer_id_, static_cast<std::uint8_t>(0x43u | (4u - size) << 2), address_,
                                static_cast<std::uint32_t>(low_first(data_))));
    } else {
        out.push_back(sdo_frame(answer_id_, 0x41, address_, size));
        phase_ = Phase::read;
    }
}

void SdoServer::on_read(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 3) return abort(Abort::command, out);
    if (((b & 0x10u) != 0) != toggle_) return abort(Abort::toggle, out);
    const auto n = std::min(segment_bytes, data_.size() - at_);
    std::array<std::uint8_t, 8> bytes{};
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at_), n, bytes.begin() + 1);
    at_ += n;
    const bool last = at_ == data_.size();
    bytes[0] = static_cast<std::uint8_t>((toggle_ ? 0x10u : 0u) | (segment_bytes - n) << 1 | (last ? 1u : 0u));
    out.push_back(data_frame(answer_id_, bytes));
    toggle_ = !toggle_;
    if (last) phase_ = Phase::idle;
}

void SdoServer::store(std::span<const std::uint8_t> bytes, bool sized, const Frame& yes, std::vector<Frame>& out) {
    const Abort fault = store_.write(address_, bytes, sized);
    if (fault != Abort::none) return abort(fault, out);
    out.push_back(yes);
    phase_ = Phase::idle;
}

void SdoServer::begin_write(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    const bool sized = (b & 1u) != 0;
    const Frame yes = sdo_frame(answer_id_, 0x60, address_);
    if ((b & 2u) != 0) return store(f.data().subspan(4, sized ? 4u - (b >> 2 & 3u) : 4u), sized, yes, out);
    if (sized) announced_ = value_of(f);
    const Abort fault = store_.admits(address_, announced_ ? std::optional<std::size_t>(*announced_) : std::nullopt);
    if (fault != Abort::none) return abort(fault, out);
    if (announced_.value_or(0) > limits_.most_bytes) return abort(Abort::memory, out);
    out.push_back(yes);
    phase_ = Phase::write;
}

void SdoServer::on_write(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 0) return abort(Abort::command, out);
    if (((b & 0x10u) != 0) != toggle_) return abort(Abort::toggle, out);
    const std::size_t n = segment_bytes - (b >> 1 & 7u);
    const bool last = (b & 1u) != 0;
    if ((n == 0 && !last) || data_.size() + n > announced_.value_or(UINT32_MAX)) return abort(Abort::length, out);
    if (data_.size() + n > limits_.most_bytes) return abort(Abort::memory, out);
    data_.insert(data_.end(), f.data().begin() + 1, f.data().begin() + 1 + static_cast<std::ptrdiff_t>(n));
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(toggle_ ? 0x30 : 0x20)};
    const Frame yes = data_frame(answer_id_, bytes);
    if (last) {
        if (announced_ && data_.size() != *announced_) return abort(Abort::length, out);
        return store(data_, true, yes, out);
    }
    out.push_back(yes);
    toggle_ = !toggle_;
}

void SdoServer::on_block_read(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 5) return abort(Abort::command, out);
    const unsigned step = b & 3u;
    if (phase_ == Phase::block_read_end) {
        if (step != 1) return abort(Abort::command, out);
        phase_ = Phase::idle;
        return;
    }
    if (phase_ == Phase::block_read_begin) {
        if (step != 3) return abort(Abort::command, out);
    } else {
        if (step != 2) return abort(Abort::command, out);
        const Abort fault = sender_.on_acknowledge(f.storage[1]);
        if (fault != Abort::none) return abort(fault, out);
        block_size_ = f.storage[2];
        if (block_size_ == 0 || block_size_ > most_block_size) return abort(Abort::block_size, out);
    }
    if (phase_ == Phase::block_read && sender_.complete()) {
        std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(0xC1u | unsigned{sender_.unused()} << 2)};
        if (client_crc_) put_low_first(sender_.crc(), std::span(bytes).subspan(1, 2));
        out.push_back(data_frame(answer_id_, bytes));
        phase_ = Phase::block_read_end;
        return;
    }
    sender_.send(answer_id_, block_size_, out);
    phase_ = Phase::block_read;
}

void SdoServer::begin_block_write(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    client_crc_ = (b & 4u) != 0;
    if ((b & 2u) != 0) announced_ = value_of(f);
    const Abort fault = store_.admits(address_, announced_ ? std::optional<std::size_t>(*announced_) : std::nullopt);
    if (fault != Abort::none) return abort(fault, out);
    if (announced_.value_or(0) > limits_.most_bytes) return abort(Abort::memory, out);
    receiver_.begin(limits_, announced_);
    out.push_back(sdo_frame(answer_id_, 0xA4, address_, limits_.block_size));
    phase_ = Phase::block_write;
}

void SdoServer::on_block_write(const Frame& f, std::vector<Frame>& out) {
    const auto step = receiver_.on_segment(f);
    if (step.abort != Abort::none) return abort(step.abort, out);
    if (!step.acknowledge) return;
    const std::array<std::uint8_t, 8> bytes{0xA2, step.sequence, limits_.block_size};
    out.push_back(data_frame(answer_id_, bytes));
    if (receiver_.complete()) phase_ = Phase::block_write_end;
}

void SdoServer::on_block_write_end(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 6 || (b & 3u) != 1) return abort(Abort::command, out);
    const auto crc = static_cast<std::uint16_t>(low_first(f.data().subspan(1, 2)));
    const Abort fault = receiver_.finish(b >> 2 & 7u, client_crc_ ? std::optional(crc) : std::nullopt);
    if (fault != Abort::none) return abort(fault, out);
    const auto bytes = receiver_.take();
    store(bytes, true, sdo_frame(answer_id_, 0xA1, {}), out);
}

}  // namespace axisgate::canopen
