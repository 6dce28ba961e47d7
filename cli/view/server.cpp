/// The viewer's server: cpp-httplib behind a check of request heads.
#include "cli/view/server.hpp"

#include <httplib.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cli/view/http_stream.hpp"
#include "fase/record/recording/input_file.hpp"
#include "viewer/embedded.hpp"

namespace fase::cli {
namespace {

constexpr HttpStream::Seconds timeout{5};
constexpr std::size_t soft_connection_limit = 128, max_connections = 512;

constexpr std::array<std::pair<const char*, const char*>, 6> common_headers{{
    {"X-Content-Type-Options", "nosniff"},
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
     "frame-ancestors 'none'"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
}};

/// Open connections, waiting for a request or being served.
class Connections {
public:
    void add(int socket) {
        const std::lock_guard lock(mutex_);
        open_[socket] = {++last_, true};
        if (stopped_) ::shutdown(socket, SHUT_RDWR);
    }
    void set_waiting(int socket, bool waiting) {
        const std::lock_guard lock(mutex_);
        open_[socket].waiting = waiting;
    }
    void close(int socket) {
        const std::lock_guard lock(mutex_);
        open_.erase(socket);
        ::shutdown(socket, SHUT_RDWR);
        ::close(socket);
    }
    /// Closes the connection that has waited longest; if none waits, the oldest.
    void drop_oldest() {
        const std::lock_guard lock(mutex_);
        const std::pair<const int, Connection>* oldest = nullptr;
        for (const auto& one : open_) {
            if (one.second.dropped) continue;
            const auto rank = [](const Connection& c) { return std::pair(!c.waiting, c.number); };
            if (oldest == nullptr || rank(one.second) < rank(oldest->second)) oldest = &one;
        }
        if (oldest == nullptr) return;
        ::shutdown(oldest->first, SHUT_RDWR);
        open_[oldest->first].dropped = true;
    }
    void stop() {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        for (const auto& one : open_) ::shutdown(one.first, SHUT_RDWR);
    }

private:
    struct Connection {
        std::uint64_t number = 0;
        bool waiting = true, dropped = false;
    };
    std::mutex mutex_;
    std::map<int, Connection> open_;
    std::uint64_t last_ = 0;
    bool stopped_ = false;
};

/// One thread per connection. Above the soft limit, closes the oldest waiting connection.
class ConnectionThreads : public httplib::TaskQueue {
public:
    explicit ConnectionThreads(Connections& connections) : connections_(connections) {}
    // void in cpp-httplib 0.11, bool ("accepted") since 0.14.
    using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));
    Enqueued enqueue(std::function<void()> work) override {
        {
            std::unique_lock lock(mutex_);
            while (running_ >= soft_connection_limit) {
                connections_.drop_oldest();
                if (running_ < max_connections) break;
                ended_.wait_for(lock, std::chrono::milliseconds(10));
            }
            ++running_;
        }
        const auto run = [this, work = std::move(work)] {
            work();
            const std::lock_guard lock(mutex_);
            --running_;
            ended_.notify_all();
        };
        try {
            std::thread(run).detach();
        } catch (const std::system_error&) {
            run();
        }
        return Enqueued(true);
    }
    void shutdown() override {
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [&] { return running_ == 0; });
    }

private:
    Connections& connections_;
    std::mutex mutex_;
    std::condition_variable ended_;
    std::size_t running_ = 0;
};

const char* name_of_status(int code) {
    switch (code) {
        case 403: return "Forbidden";
        case 405: return "Method Not Allowed";
        case 408: return "Request Timeout";
        case 414: return "URI Too Long";
        case 431: return "Request Header Fields Too Large";
        default: return "Bad Request";
    }
}

std::string refusal(const HttpVerdict& verdict) {
    std::string text = "HTTP/1.1 " + std::to_string(verdict.code) + " " + name_of_status(verdict.code) + "\r\n";
    for (const auto& [name, value] : common_headers) text += std::string(name) + ": " + value + "\r\n";
    if (verdict.code == 405) text += "Allow: GET, HEAD\r\n";
    const std::string body = std::string(verdict.reason) + "\n";
    return text + "Content-Type: text/plain; charset=utf-8\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\nConnection: close\r\n\r\n" + body;
}

void refuse(httplib::Response& response, int code, const std::string& reason) {
    response.status = code;
    response.set_content(reason + "\n", "text/plain; charset=utf-8");
}

class Server : public httplib::Server {
public:
    Server(std::string recording, Connections& connections)
        : recording_(std::move(recording)), connections_(connections) {
        new_task_queue = [this] { return new ConnectionThreads(connections_); };
        set_socket_options([](socket_t socket) {
            const int yes = 1;  // not SO_REUSEPORT: two servers must not share a port
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        httplib::Headers headers;
        for (const auto& [name, value] : common_headers) headers.emplace(name, value);
        set_default_headers(std::move(headers));
        set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
            answer(request, response);
            return HandlerResponse::Handled;
        });
    }
    /// Call after binding.
    void set_port(int port) {
        port_ = port;
        ::listen(svr_sock_, 1024);  // the library's backlog of 5 delays clients by a second each
    }

private:
    void answer(const httplib::Request& request, httplib::Response& response) const {
        const auto send = [&](std::string_view content, const char* type) {
            response.set_content(content.data(), content.size(), type);
        };
        if (request.path == "/" || request.path == "/index.html")
            return send(viewer::page(), "text/html; charset=utf-8");
        if (request.path == "/viewer.js") return send(viewer::script(), "text/javascript; charset=utf-8");
        if (request.path == "/viewer.css") return send(viewer::style(), "text/css; charset=utf-8");
        if (request.path == "/recording") return send_recording(response);
        if (request.path == "/favicon.ico") {
            response.status = 204;
            return;
        }
        refuse(response, 404, "no such page");
    }
    void send_recording(httplib::Response& response) const {
        Result<record::InputFile> opened = record::InputFile::open(recording_);
        if (!opened) opened = record::InputFile::open(recording_ + ".part");
        if (!opened) return refuse(response, 404, "the recording can no longer be read: " + opened.error().text());
        const auto file = std::make_shared<record::InputFile>(std::move(*opened));
        if (file->size() == 0) return refuse(response, 404, "the recording is empty: " + recording_);
        response.set_content_provider(
            static_cast<std::size_t>(file->size()), "application/octet-stream",
            [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                std::vector<std::byte> part(std::min(length, std::size_t(1) << 18));
                if (!file->read(offset, part))
                    return false;  // the file shrank: closes the connection early, the page reports it
                return sink.write(reinterpret_cast<const char*>(part.data()), part.size());
            });
    }
    /// Answers one request. Since 0.16, cpp-httplib also takes the addresses of both ends; the server does not use
    /// them.
    template <class Library> static bool process(Library& library, HttpStream& stream, bool& closes) {
        if constexpr (requires { library.process_request(stream, false, closes, nullptr); }) {
            return library.process_request(stream, false, closes, nullptr);
        } else {
            return library.process_request(stream, "", 0, "", 0, false, closes, nullptr);
        }
    }
    bool process_and_close_socket(socket_t socket) override {
        connections_.add(socket);
        HttpStream stream(socket, timeout);
        bool closed = false;
        while (!closed) {
            connections_.set_waiting(socket, true);
            const HttpStream::Waited waited = stream.next_head(port_);
            connections_.set_waiting(socket, false);
            if (waited == HttpStream::Waited::TimedOut)
                stream.send(refusal({408, "the request was not received in time"}));
            if (waited == HttpStream::Waited::Refused) stream.send(refusal(stream.verdict()));
            if (waited != HttpStream::Waited::Head) break;
            bool close_requested = false;
            closed = !process(*this, stream, close_requested) || close_requested;
        }
        // Read the rest first: closing a socket with unread bytes would discard sent data.
        ::shutdown(socket, SHUT_WR);
        char rest[4096];
        for (int i = 0; i < 64 && ::recv(socket, rest, sizeof rest, MSG_DONTWAIT) > 0; ++i) {
        }
        connections_.close(socket);
        return true;
    }

    std::string recording_;
    Connections& connections_;
    int port_ = 0;
};

}  // namespace

struct ViewServer::State {
    explicit State(const std::string& recording) : server(recording, connections) {}
    Connections connections;
    Server server;
    int port = 0;
    std::atomic<bool> ended{false};
};

ViewServer::ViewServer(std::unique_ptr<State> state) : state_(std::move(state)) {}
ViewServer::ViewServer(ViewServer&&) noexcept = default;
ViewServer& ViewServer::operator=(ViewServer&&) noexcept = default;
ViewServer::~ViewServer() = default;

Result<ViewServer> ViewServer::listen(const std::string& recording, int port) {
    auto state = std::make_unique<State>(recording);
    if (port == 0) {
        state->port = state->server.bind_to_any_port("127.0.0.1");
    } else {
        state->port = state->server.bind_to_port("127.0.0.1", port) ? port : -1;
    }
    if (state->port <= 0) {
        return Error{Status::Io, "127.0.0.1:" + std::to_string(port),
                     "cannot listen: the port is in use or not allowed", "choose another port with --port"};
    }
    state->server.set_port(state->port);
    return ViewServer(std::move(state));
}

int ViewServer::port() const { return state_->port; }
void ViewServer::run() {
    state_->server.listen_after_bind();
    state_->ended = true;
}
void ViewServer::stop() {
    // The library ignores stop() before its loop runs.
    while (!state_->server.is_running() && !state_->ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    state_->connections.stop();
    state_->server.stop();
}

}  // namespace fase::cli
