#pragma once
/// One connection of a browser, with time limits, as cpp-httplib reads and writes it.
#include <httplib.h>

#include <chrono>
#include <string>

#include "cli/view/http_guard.hpp"

namespace fase::cli {

/// Reads whole heads of requests itself and hands them on; writes with a time limit. Does not own the socket.
class HttpStream : public httplib::Stream {
public:
    using Seconds = std::chrono::duration<double>;
    /// @param patience how long a head may take to come, and how long a client may take no bytes
    HttpStream(socket_t socket, Seconds patience) : socket_(socket), patience_(patience) {}

    /// What came of waiting for a request.
    enum class Waited { Head, Closed, TooLate, Refused };
    /// Waits for a whole head; read() then gives it. Refused: see verdict().
    Waited next_head(int port);
    [[nodiscard]] HttpVerdict verdict() const { return verdict_; }
    /// Sends `text`, as far as the client takes it.
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
    Seconds patience_;
    std::string buffer_;
    std::size_t head_ = 0;  ///< bytes of the present head at the start of the buffer
    std::size_t read_ = 0;  ///< of these, handed on
    HttpVerdict verdict_;
};

}  // namespace fase::cli
