#pragma once
/// Serves the viewer and one recording to browsers on this machine.
#include <memory>
#include <string>

#include "fase/core/result.hpp"

namespace fase::cli {

/// Answers on 127.0.0.1 only: `/`, `/viewer.js`, `/viewer.css` from the program itself, `/recording` from the file,
/// which is opened anew for each request (so it may be replaced or go away: then that request gets an error in words).
/// Everything else is refused, see http_guard.hpp. A request's head must come within 5 s; of clients that only wait,
/// the oldest are dropped when there are many.
class ViewServer {
public:
    /// Listens. Io when the port is taken, naming it. @param port 0: any free one
    static Result<ViewServer> listen(const std::string& recording, int port);
    ViewServer(ViewServer&&) noexcept;
    ViewServer& operator=(ViewServer&&) noexcept;
    /// Ends all connections.
    ~ViewServer();
    [[nodiscard]] int port() const;
    /// Answers until stop() is called from another thread.
    void run();
    void stop();

private:
    struct State;
    explicit ViewServer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace fase::cli
