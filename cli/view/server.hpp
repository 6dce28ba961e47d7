#pragma once
/// Serves the viewer and one recording to browsers on this machine.
#include <memory>
#include <string>

#include "fase/core/result.hpp"

namespace fase::cli {

/// Listens on 127.0.0.1 only. Serves `/`, `/viewer.js` and `/viewer.css` from the program itself, and `/recording` from
/// the file, which is opened for each request: if the file is missing, that request gets an error text. Refuses
/// everything else, see http_guard.hpp. A request head must arrive within 5 s. With many connections, the oldest
/// waiting ones are closed.
class ViewServer {
public:
    /// Starts to listen. Io, with the address, if the port is in use. @param port 0: any free port
    static Result<ViewServer> listen(const std::string& recording, int port);
    ViewServer(ViewServer&&) noexcept;
    ViewServer& operator=(ViewServer&&) noexcept;
    /// Closes all connections.
    ~ViewServer();
    [[nodiscard]] int port() const;
    /// Answers requests until another thread calls stop().
    void run();
    void stop();

private:
    struct State;
    explicit ViewServer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::cli
