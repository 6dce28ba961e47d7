/// A browser's connection with time limits.
#include "cli/view/http_stream.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace fase::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits for `events`. False after `deadline` or if the socket is broken.
bool wait_for(int socket, short events, Clock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0) return false;
        pollfd waiting{socket, events, 0};
        const int ready = ::poll(&waiting, 1, static_cast<int>(std::min<long long>(left, 60000)));
        if (ready > 0) return true;
        if (ready < 0 && errno != EINTR) return false;
    }
}

}  // namespace

HttpStream::Waited HttpStream::next_head(int port) {
    buffer_.erase(0, head_);
    head_ = read_ = 0;
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout_);
    std::size_t searched = 0;
    for (;;) {
        const std::size_t end = buffer_.find("\r\n\r\n", searched > 3 ? searched - 3 : 0);
        if (end != buffer_.npos) {
            verdict_ = check_head(std::string_view(buffer_).substr(0, end + 4), port);
            if (verdict_.code != 0) return Waited::Refused;
            head_ = end + 4;
            return Waited::Head;
        }
        searched = buffer_.size();
        verdict_ = check_partial_head(buffer_);
        if (verdict_.code != 0) return Waited::Refused;
        if (!wait_for(socket_, POLLIN, deadline)) return buffer_.empty() ? Waited::Closed : Waited::TimedOut;
        char bytes[4096];
        const ssize_t received = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
        if (received > 0) {
            buffer_.append(bytes, static_cast<std::size_t>(received));
        } else if (received == 0 || (errno != EINTR && errno != EAGAIN)) {
            return Waited::Closed;
        }
    }
}

bool HttpStream::is_writable() const {
    return wait_for(socket_, POLLOUT, Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout_));
}

ssize_t HttpStream::read(char* bytes, std::size_t size) {
    const std::size_t part = std::min(size, head_ - read_);
    std::memcpy(bytes, buffer_.data() + read_, part);
    read_ += part;
    return static_cast<ssize_t>(part);
}

ssize_t HttpStream::write(const char* bytes, std::size_t size) {
    std::size_t done = 0;
    while (done < size) {
        if (!is_writable()) return -1;
        const ssize_t sent = ::send(socket_, bytes + done, size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            done += static_cast<std::size_t>(sent);
        } else if (sent == 0 || (errno != EINTR && errno != EAGAIN)) {
            return -1;
        }
    }
    return static_cast<ssize_t>(done);
}

void HttpStream::get_remote_ip_and_port(std::string& ip, int& port) const {
    ip = "127.0.0.1";
    port = 0;
}
void HttpStream::get_local_ip_and_port(std::string& ip, int& port) const {
    ip = "127.0.0.1";
    port = 0;
}

}  // namespace fase::cli
