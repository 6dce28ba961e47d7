#pragma once
/// A browser's connection with time limits, in the form that cpp-httplib reads and writes.
#include <httplib.h>
#include <cstddef>

#include <chrono>
#include <string>

#include "cli/view/http_guard.hpp"

namespace fase::cli {

/// Reads complete request heads and passes them to cpp-httplib; writes with a time limit. Does not own the socket.
class HttpStream : public httplib::Stream {
public:
    using Seconds = std::chrono::duration<double>;
    /// @param timeout for receiving a complete head, and for each time that the client must accept bytes
    HttpStream(socket_t socket, Seconds timeout) : socket_(socket), timeout_(timeout) {}

    /// The result of waiting for a request.
    enum class Waited { Head, Closed, TimedOut, Refused };
    /// Waits for a complete head, which read() then returns. Refused: see verdict().
    Waited next_head(int port);
    [[nodiscard]] HttpVerdict verdict() const { return verdict_; }
    /// Sends `text`; stops when the client accepts no more.
    void send(std::string_view text) { write(text.data(), text.size()); }

    [[nodiscard]] bool is_readable() const override { return read_ < head_; }
    [[nodiscard]] bool is_writable() const override;
    ssize_t read(char* bytes, std::size_t size) override;
    using httplib::Stream::write;
    ssize_t write(const char* bytes, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    [[nodiscard]] socket_t socket() const override { return socket_; }

private:
    socket_t socket_;
    Seconds timeout_;
    std::string buffer_;
    std::size_t head_ = 0;  ///< bytes of the current head at the start of the buffer
    std::size_t read_ = 0;  ///< of these, already read
    HttpVerdict verdict_;
};

}  // namespace fase::cli
