// SdoClient: the phases of a transfer, driven by the messages of the node. A length is trusted only when its bytes have arrived.
#include "gateway/protocols/canopen/sdo_client.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

namespace axisgate::canopen {

std::string to_text(const SdoEnd& e) {
    if (e.done()) return fmt::format("{} {}", to_text(e.address), e.write ? "written" : "read");
    const std::string what = fmt::format("{} could not be {}", to_text(e.address), e.write ? "written" : "read");
    if (e.by_node) return fmt::format("{}: the node refused: {}", what, to_text(e.abort));
    if (e.abort == Abort::timeout) return what + ": the node did not answer in time";
    return fmt::format("{}: broken off here: {}", what, to_text(e.abort));
}

bool SdoClient::read(Address address, Instant now, std::vector<Frame>& out, bool block) {
    if (busy()) return false;
    address_ = address;
    write_ = false;
    block_ = block;
    begin(now, out);
    return true;
}
bool SdoClient::write(Address address, std::vector<std::uint8_t> data, Instant now, std::vector<Frame>& out, bool block) {
    if (busy()) return false;
    address_ = address;
    write_ = true;
    block_ = block;
    data_ = std::move(data);
    begin(now, out);
    return true;
}

void SdoClient::begin(Instant now, std::vector<Frame>& out) {
    deadline_ = now + limits_.patience;
    toggle_ = false;
    at_ = 0;
    announced_.reset();
    if (!write_) {
        data_.clear();
        phase_ = block_ ? Phase::block_read_begin : Phase::read_begin;
        // Command 5, with a checksum; the block size, and no threshold below which the node may leave the block protocol.
        out.push_back(block_ ? sdo_frame(request_id_, 0xA4, address_, limits_.block_size) : sdo_frame(request_id_, 0x40, address_));
        return;
    }
    const auto size = static_cast<std::uint32_t>(data_.size());
    phase_ = block_ ? Phase::block_write_begin : Phase::write_begin;
    if (block_) {
        out.push_back(sdo_frame(request_id_, 0xC6, address_, size));
    } else if (size >= 1 && size <= 4) {
        out.push_back(sdo_frame(request_id_, static_cast<std::uint8_t>(0x23u | (4u - size) << 2), address_,
                                static_cast<std::uint32_t>(low_first(data_))));
        at_ = size;
    } else {
        out.push_back(sdo_frame(request_id_, 0x21, address_, size));
    }
}

void SdoClient::ask_segment(std::vector<Frame>& out) {
    const std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(0x60u | (toggle_ ? 0x10u : 0u))};
    out.push_back(data_frame(request_id_, bytes));
}

void SdoClient::send_segment(std::vector<Frame>& out) {
    const auto n = std::min(segment_bytes, data_.size() - at_);
    std::array<std::uint8_t, 8> bytes{};
    std::copy_n(data_.begin() + static_cast<std::ptrdiff_t>(at_), n, bytes.begin() + 1);
    at_ += n;
    bytes[0] = static_cast<std::uint8_t>((toggle_ ? 0x10u : 0u) | (segment_bytes - n) << 1 | (at_ == data_.size() ? 1u : 0u));
    out.push_back(data_frame(request_id_, bytes));
}

void SdoClient::send_block(std::uint8_t block_size, std::vector<Frame>& out) {
    sender_.send(request_id_, block_size, out);
    phase_ = Phase::block_write;
}

std::optional<SdoEnd> SdoClient::end(Abort abort, bool by_node) {
    phase_ = Phase::idle;
    SdoEnd e{address_, write_, abort, by_node, {}};
    if (!write_ && e.done()) e.data = std::move(data_);
    data_.clear();
    return e;
}
std::optional<SdoEnd> SdoClient::stop(Abort why, std::vector<Frame>& out) {
    if (!busy()) return std::nullopt;
    out.push_back(abort_frame(request_id_, address_, why));
    return end(why, false);
}
bool SdoClient::repeat(Instant now, std::vector<Frame>& out) {
    if (phase_ != Phase::read_begin && phase_ != Phase::write_begin) return false;
    begin(now, out);
    return true;
}
void SdoClient::abandon() noexcept {
    phase_ = Phase::idle;
    data_.clear();
}
std::optional<SdoEnd> SdoClient::on_deadline(Instant now, std::vector<Frame>& out) {
    if (!busy() || now < deadline_) return std::nullopt;
    return stop(Abort::timeout, out);
}

bool SdoClient::beginning() const noexcept {
    return phase_ == Phase::read_begin || phase_ == Phase::write_begin || phase_ == Phase::block_read_begin ||
           phase_ == Phase::block_write_begin;
}

std::optional<SdoEnd> SdoClient::on_frame(const Frame& f, Instant now, std::vector<Frame>& out) {
    if (!is_data(f, answer_id_)) return std::nullopt;
    if (!busy() || f.size != 8) {
        ++strays_;
        return std::nullopt;
    }
    if (f.storage[0] == 0x80) return on_abort(f, now, out);
    // The remainder of a transfer that was given up names another entry, or none.
    if (beginning()) {
        const unsigned command = f.storage[0] >> 5;
        const bool answers = phase_ == Phase::read_begin          ? command == 2
                             : phase_ == Phase::write_begin       ? command == 3
                             : phase_ == Phase::block_write_begin ? command == 5 && (f.storage[0] & 3u) == 0
                                                                  : command == 2 || (command == 6 && (f.storage[0] & 1u) == 0);
        if (!answers || address_of(f) != address_) {
            ++strays_;
            return std::nullopt;
        }
    }
    deadline_ = now + limits_.patience;
    switch (phase_) {
        case Phase::read_segments:
            return on_read_segment(f, out);
        case Phase::write_segments:
            return on_write_segment(f, out);
        case Phase::block_read:
            return on_block_read(f, out);
        case Phase::block_read_end:
            return on_block_read_end(f, out);
        case Phase::block_write:
            return on_block_write(f, out);
        case Phase::block_write_end:
            if (f.storage[0] >> 5 != 5 || (f.storage[0] & 3u) != 1) return stop(Abort::command, out);
            return end(Abort::none, false);
        default:
            return on_begun(f, out);
    }
}

std::optional<SdoEnd> SdoClient::on_abort(const Frame& f, Instant now, std::vector<Frame>& out) {
    // Nodes that do not know the command at all answer without an entry.
    if (address_of(f) != address_ && address_of(f) != Address{}) {
        ++strays_;
        return std::nullopt;
    }
    const auto code = static_cast<Abort>(value_of(f));
    if (code == Abort::command && (phase_ == Phase::block_read_begin || phase_ == Phase::block_write_begin)) {
        block_ = false;
        begin(now, out);
        return std::nullopt;
    }
    return end(code == Abort::none ? Abort::general : code, true);
}

std::optional<SdoEnd> SdoClient::on_begun(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    switch (phase_) {
        case Phase::write_begin:
            if (at_ == data_.size() && !data_.empty()) return end(Abort::none, false);
            phase_ = Phase::write_segments;
            send_segment(out);
            return std::nullopt;
        case Phase::block_write_begin: {
            const std::uint8_t block_size = f.storage[4];
            if (block_size == 0 || block_size > most_block_size) return stop(Abort::block_size, out);
            node_crc_ = (b & 4u) != 0;
            sender_.begin(std::move(data_), limits_.stalls);
            send_block(block_size, out);
            return std::nullopt;
        }
        case Phase::block_read_begin:
            if (b >> 5 == 2) return on_read_begun(f, out);
            node_crc_ = (b & 4u) != 0;
            if ((b & 2u) != 0) announced_ = value_of(f);
            if (announced_.value_or(0) > limits_.most_bytes) return stop(Abort::memory, out);
            receiver_.begin(limits_, announced_);
            phase_ = Phase::block_read;
            out.push_back(sdo_frame(request_id_, 0xA3, {}));
            return std::nullopt;
        default:
            return on_read_begun(f, out);
    }
}

std::optional<SdoEnd> SdoClient::on_read_begun(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    const bool sized = (b & 1u) != 0;
    if ((b & 2u) != 0) {
        const std::size_t n = sized ? 4u - (b >> 2 & 3u) : 4u;
        if (n > limits_.most_bytes) return stop(Abort::memory, out);
        data_.assign(f.data().begin() + 4, f.data().begin() + 4 + static_cast<std::ptrdiff_t>(n));
        return end(Abort::none, false);
    }
    if (sized) announced_ = value_of(f);
    if (announced_.value_or(0) > limits_.most_bytes) return stop(Abort::memory, out);
    phase_ = Phase::read_segments;
    ask_segment(out);
    return std::nullopt;
}

std::optional<SdoEnd> SdoClient::on_read_segment(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 0) return stop(Abort::command, out);
    if (((b & 0x10u) != 0) != toggle_) return stop(Abort::toggle, out);
    const std::size_t n = segment_bytes - (b >> 1 & 7u);
    const bool last = (b & 1u) != 0;
    // Empty segments could continue for ever.
    if (n == 0 && !last) return stop(Abort::length, out);
    if (data_.size() + n > announced_.value_or(UINT32_MAX)) return stop(Abort::length, out);
    if (data_.size() + n > limits_.most_bytes) return stop(Abort::memory, out);
    data_.insert(data_.end(), f.data().begin() + 1, f.data().begin() + 1 + static_cast<std::ptrdiff_t>(n));
    if (last) return announced_ && data_.size() != *announced_ ? stop(Abort::length, out) : end(Abort::none, false);
    toggle_ = !toggle_;
    ask_segment(out);
    return std::nullopt;
}

std::optional<SdoEnd> SdoClient::on_write_segment(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 1) return stop(Abort::command, out);
    if (((b & 0x10u) != 0) != toggle_) return stop(Abort::toggle, out);
    if (at_ == data_.size()) return end(Abort::none, false);
    toggle_ = !toggle_;
    send_segment(out);
    return std::nullopt;
}

std::optional<SdoEnd> SdoClient::on_block_read(const Frame& f, std::vector<Frame>& out) {
    const auto step = receiver_.on_segment(f);
    if (step.abort != Abort::none) return stop(step.abort, out);
    if (!step.acknowledge) return std::nullopt;
    const std::array<std::uint8_t, 8> bytes{0xA2, step.sequence, limits_.block_size};
    out.push_back(data_frame(request_id_, bytes));
    if (receiver_.complete()) phase_ = Phase::block_read_end;
    return std::nullopt;
}

std::optional<SdoEnd> SdoClient::on_block_read_end(const Frame& f, std::vector<Frame>& out) {
    const std::uint8_t b = f.storage[0];
    if (b >> 5 != 6 || (b & 3u) != 1) return stop(Abort::command, out);
    const auto crc = static_cast<std::uint16_t>(low_first(f.data().subspan(1, 2)));
    const Abort fault = receiver_.finish(b >> 2 & 7u, node_crc_ ? std::optional(crc) : std::nullopt);
    if (fault != Abort::none) return stop(fault, out);
    data_ = receiver_.take();
    out.push_back(sdo_frame(request_id_, 0xA1, {}));
    return end(Abort::none, false);
}

std::optional<SdoEnd> SdoClient::on_block_write(const Frame& f, std::vector<Frame>& out) {
    if (f.storage[0] >> 5 != 5 || (f.storage[0] & 3u) != 2) return stop(Abort::command, out);
    const std::uint8_t block_size = f.storage[2];
    if (block_size == 0 || block_size > most_block_size) return stop(Abort::block_size, out);
    const Abort fault = sender_.on_acknowledge(f.storage[1]);
    if (fault != Abort::none) return stop(fault, out);
    if (!sender_.complete()) {
        send_block(block_size, out);
        return std::nullopt;
    }
    std::array<std::uint8_t, 8> bytes{static_cast<std::uint8_t>(0xC1u | unsigned{sender_.unused()} << 2)};
    if (node_crc_) put_low_first(sender_.crc(), std::span(bytes).subspan(1, 2));
    out.push_back(data_frame(request_id_, bytes));
    phase_ = Phase::block_write_end;
    return std::nullopt;
}

}  // namespace axisgate::canopen
