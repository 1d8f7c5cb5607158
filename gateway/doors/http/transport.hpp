// The bytes of one connection, plain at first, over TLS after a handshake. The session decides about TLS and time limits. One read and one
// write at a time.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <memory>
#include <optional>
#include <utility>

namespace axisgate::http {

class Transport {
public:
    using Socket = boost::asio::ip::tcp::socket;
    using executor_type = Socket::executor_type;
    using ErrorCode = boost::system::error_code;

    explicit Transport(Socket socket) : plain_(std::move(socket)) {}

    [[nodiscard]] executor_type get_executor() { return socket().get_executor(); }
    [[nodiscard]] bool secure() const noexcept { return tls_ != nullptr; }
    /// The socket below: waiting, options, cancelling. Its bytes are ciphertext once secure() is true.
    [[nodiscard]] Socket& socket() noexcept { return tls_ ? tls_->next_layer() : *plain_; }
    void cancel() {
        ErrorCode ignored;
        socket().cancel(ignored);
    }
    void close(ErrorCode& ec) { socket().close(ec); }

    /// From here on everything is TLS. `context` must outlive this object.
    template <class Handler>
    void async_handshake(boost::asio::ssl::context& context, Handler handler) {
        tls_ = std::make_unique<Tls>(std::move(*plain_), context);
        plain_.reset();
        tls_->async_handshake(boost::asio::ssl::stream_base::server, std::move(handler));
    }
    template <class Buffers, class Token>
    auto async_read_some(const Buffers& buffers, Token&& token) {
        if (tls_) return tls_->async_read_some(buffers, std::forward<Token>(token));
        return plain_->async_read_some(buffers, std::forward<Token>(token));
    }
    template <class Buffers, class Token>
    auto async_write_some(const Buffers& buffers, Token&& token) {
        if (tls_) return tls_->async_write_some(buffers, std::forward<Token>(token));
        return plain_->async_write_some(buffers, std::forward<Token>(token));
    }
    /// Sends the end (close_notify, then FIN), then calls `then`; plain: at once, from within this call.
    template <class Then>
    void end_sending(Then then) {
        if (!tls_) {
            ErrorCode ignored;
            plain_->shutdown(Socket::shutdown_send, ignored);
            return then();
        }
        tls_->async_shutdown([this, then = std::move(then)](ErrorCode) mutable {  // `then` holds the owner of this object
            ErrorCode ignored;
            socket().shutdown(Socket::shutdown_send, ignored);
            then();
        });
    }

private:
    using Tls = boost::asio::ssl::stream<Socket>;
    std::optional<Socket> plain_;
    std::unique_ptr<Tls> tls_;  ///< on the heap, so that this can be moved between sessions
};

}  // namespace axisgate::http
