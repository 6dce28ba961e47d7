/// Tests `fase view` as a program: self-contained pages, and a server that only answers browsers on this machine.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/record/artificial_run.hpp"

namespace fase::cli {
namespace {

using namespace std::chrono_literals;
using record::ArtificialRun;
using record::read_file;
using record::record_run;
using record::TemporaryFolder;
using record::write_file;
using Clock = std::chrono::steady_clock;

/// The running program with its output in a pipe.
class Program {
public:
    explicit Program(std::vector<std::string> arguments) {
        int out[2];
        EXPECT_EQ(::pipe2(out, O_CLOEXEC), 0);
        arguments.insert(arguments.begin(), FASE_PROGRAM);
        id_ = ::fork();
        if (id_ == 0) {
            std::vector<char*> pointers;
            for (std::string& argument : arguments) pointers.push_back(argument.data());
            pointers.push_back(nullptr);
            ::signal(SIGINT, SIG_DFL);
            ::dup2(out[1], 1);
            ::dup2(out[1], 2);
            ::execv(FASE_PROGRAM, pointers.data());
            ::_exit(127);
        }
        ::close(out[1]);
        out_ = out[0];
    }
    ~Program() {
        if (id_ > 0 && !ended_) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
        }
        ::close(out_);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// Reads its output until `word` appears or the program ends.
    const std::string& read_until(const std::string& word) {
        char bytes[1024];
        while (text_.find(word) == text_.npos) {
            const ssize_t count = ::read(out_, bytes, sizeof bytes);
            if (count <= 0) break;
            text_.append(bytes, static_cast<std::size_t>(count));
        }
        return text_;
    }
    void send(int signal) const { ::kill(id_, signal); }
    /// Returns its exit code; -1 if a signal ended it.
    int wait() {
        int status = 0;
        ::waitpid(id_, &status, 0);
        ended_ = true;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int run() {
        read_until("\x01");
        return wait();
    }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    pid_t id_ = -1;
    int out_ = -1;
    bool ended_ = false;
    std::string text_;
};

class Connection {
public:
    explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
    }
    Connection(Connection&& other) noexcept : socket_(other.socket_), connected_(other.connected_) {
        other.socket_ = -1;
    }
    ~Connection() {
        if (socket_ >= 0) ::close(socket_);
    }
    [[nodiscard]] bool connected() const { return connected_; }
    void send(const std::string& text) const { (void)::send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
    void end_sending() const { ::shutdown(socket_, SHUT_WR); }
    /// Reads until the other side closes, or the time limit.
    [[nodiscard]] std::string read_all(std::chrono::milliseconds limit = 15s) const {
        std::string text;
        const auto deadline = Clock::now() + limit;
        char bytes[65536];
        for (;;) {
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
            pollfd waiting{socket_, POLLIN, 0};
            if (left <= 0 || ::poll(&waiting, 1, static_cast<int>(left)) <= 0) return text + "<no end>";
            const ssize_t count = ::recv(socket_, bytes, sizeof bytes, 0);
            if (count <= 0) return text;
            text.append(bytes, static_cast<std::size_t>(count));
        }
    }

private:
    int socket_;
    bool connected_ = false;
};

class ViewServer : public testing::Test {
protected:
    ViewServer() {
        EXPECT_TRUE(record_run(file_, ArtificialRun(40), 100));
        program_.emplace(std::vector<std::string>{"view", file_, "--port", "0"});
        const std::string mark = "http://127.0.0.1:";
        const std::string& text = program_->read_until("Ctrl-C");
        const std::size_t at = text.find(mark);
        EXPECT_NE(at, text.npos) << text;
        if (at != text.npos) port_ = std::atoi(text.c_str() + at + mark.size());
    }
    ~ViewServer() override {
        if (!program_) return;
        EXPECT_NE(answer("GET", "/viewer.css").find("200 OK"), std::string::npos) << "the server has ended";
        const auto begin = Clock::now();
        program_->send(SIGINT);
        EXPECT_EQ(program_->wait(), 130);
        EXPECT_LT(Clock::now() - begin, 2s);
    }
    [[nodiscard]] std::string answer_to(const std::string& request) const {
        const Connection connection(port_);
        connection.send(request);
        return connection.read_all();
    }
    [[nodiscard]] std::string host() const { return "Host: localhost:" + std::to_string(port_) + "\r\n"; }
    [[nodiscard]] std::string answer(const std::string& method, const std::string& target,
                                     const std::string& headers = "") const {
        return answer_to(method + " " + target + " HTTP/1.1\r\n" + host() + headers + "Connection: close\r\n\r\n");
    }
    static int code_of(const std::string& answer) {
        return answer.starts_with("HTTP/1.1 ") ? std::atoi(answer.c_str() + 9) : 0;
    }
    static std::string body_of(const std::string& answer) {
        const std::size_t at = answer.find("\r\n\r\n");
        return at == answer.npos ? "" : answer.substr(at + 4);
    }

    TemporaryFolder folder_;
    std::string file_ = folder_ / "run.faserec";
    std::optional<Program> program_;
    int port_ = 0;
};

TEST_F(ViewServer, ServesThePageAndTheRecording) {
    const std::string page = answer("GET", "/");
    EXPECT_EQ(code_of(page), 200);
    EXPECT_NE(page.find("Content-Type: text/html"), page.npos);
    EXPECT_NE(page.find("viewer.js"), page.npos);
    EXPECT_EQ(body_of(answer("GET", "/index.html")), body_of(page));
    EXPECT_GT(body_of(answer("GET", "/viewer.js")).size(), 100000u);
    const std::string recording = answer("GET", "/recording");
    EXPECT_EQ(code_of(recording), 200);
    EXPECT_EQ(body_of(recording), read_file(file_));
    const std::string head = answer("HEAD", "/recording");
    EXPECT_EQ(code_of(head), 200);
    EXPECT_NE(head.find("Content-Length: " + std::to_string(read_file(file_).size())), head.npos);
    EXPECT_EQ(body_of(head), "");
    const std::string part = answer("GET", "/recording", "Range: bytes=8-11\r\n");
    EXPECT_EQ(code_of(part), 206);
    EXPECT_EQ(body_of(part), read_file(file_).substr(8, 4));
    EXPECT_EQ(code_of(answer("GET", "/?t=3")), 200);
    EXPECT_EQ(code_of(answer("GET", "/nothing")), 404);
}

TEST_F(ViewServer, SendsItsSecurityHeadersWithEveryAnswer) {
    for (const std::string& text : {answer("GET", "/"), answer("GET", "/recording"), answer("GET", "/nothing"),
                                    answer("POST", "/"), answer("GET", "/..")}) {
        EXPECT_NE(text.find("X-Content-Type-Options: nosniff"), text.npos) << text.substr(0, 400);
        EXPECT_NE(text.find("Content-Security-Policy: default-src 'self'"), text.npos);
        EXPECT_EQ(text.find("Access-Control-Allow"), text.npos);
    }
}

TEST_F(ViewServer, KeepsAConnectionOpenForMoreRequests) {
    const Connection connection(port_);
    const std::string request = "GET /viewer.css HTTP/1.1\r\n" + host() + "\r\n";
    connection.send(request + request + "GET /nothing HTTP/1.1\r\n" + host() + "Connection: close\r\n\r\n");
    const std::string text = connection.read_all();
    const std::size_t first = text.find("200 OK"), second = text.find("200 OK", first + 1);
    EXPECT_NE(second, text.npos);
    EXPECT_NE(text.find("404 Not Found", second), text.npos);
}

TEST_F(ViewServer, RefusesOtherHostsAndOrigins) {
    const auto with_host = [&](const std::string& name) {
        return code_of(answer_to("GET / HTTP/1.1\r\nHost: " + name + "\r\nConnection: close\r\n\r\n"));
    };
    const std::string port = ":" + std::to_string(port_);
    for (const std::string good : {"localhost", "127.0.0.1", "[::1]", "LOCALHOST"}) {
        EXPECT_EQ(with_host(good), 200) << good;
        EXPECT_EQ(with_host(good + port), 200) << good;
    }
    for (const std::string bad : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "", "127.0.0.2",
                                  "localhost:x", "localhost:", "localhost@evil.example", "[::1", "0.0.0.0"}) {
        EXPECT_EQ(with_host(bad), 403) << bad;
    }
    EXPECT_EQ(code_of(answer_to("GET / HTTP/1.1\r\nConnection: close\r\n\r\n")), 400);
    EXPECT_EQ(code_of(answer_to("GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n")), 400);
    EXPECT_EQ(code_of(answer("GET", "/", "Origin: http://localhost" + port + "\r\n")), 200);
    EXPECT_EQ(code_of(answer("GET", "/", "Origin: http://127.0.0.1" + port + "\r\n")), 200);
    for (const std::string& bad :
         {std::string("http://evil.example"), std::string("null"), std::string("http://localhost:1"),
          "https://localhost" + port, std::string("http://localhost"), std::string("file://")}) {
        EXPECT_EQ(code_of(answer("GET", "/recording", "Origin: " + bad + "\r\n")), 403) << bad;
    }
}

TEST_F(ViewServer, AnswersOnlyGetAndHead) {
    for (const std::string method :
         {"POST", "PUT", "DELETE", "TRACE", "CONNECT", "OPTIONS", "PATCH", "PRI", "get", "X"}) {
        const std::string text = answer(method, "/");
        EXPECT_EQ(code_of(text), 405) << method;
        EXPECT_NE(text.find("Allow: GET, HEAD"), text.npos);
    }
    EXPECT_EQ(code_of(answer_to("POST / HTTP/1.1\r\n" + host() + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")), 405);
    EXPECT_EQ(code_of(answer_to("GET / HTTP/1.1\r\n" + host() + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")), 400);
    EXPECT_EQ(code_of(answer_to("GET / HTTP/1.1\r\n" + host() + "Content-Length: 5\r\n\r\nhello")), 400);
    EXPECT_EQ(code_of(answer_to("GET / HTTP/1.1\r\n" + host() + "Content-Length: 0\r\nTransfer-Encoding: x\r\n\r\n")),
              400);
}

TEST_F(ViewServer, ServesNoOtherFileOfTheDisk) {
    for (const std::string target :
         {"/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2fetc/passwd", "//etc/passwd", "/etc/passwd",
          "/\\..\\etc", "/%00", "/recording%00.html", "http://evil.example/", "http://localhost/", "*", "recording",
          "/viewer.js/..", "/recording/", "/.//", "/%"}) {
        const std::string text = answer("GET", target);
        EXPECT_TRUE(code_of(text) == 400 || code_of(text) == 404) << target << " " << code_of(text);
        EXPECT_EQ(text.find("root:"), text.npos) << target;
    }
}

TEST_F(ViewServer, RefusesMalformedHeads) {
    EXPECT_EQ(code_of(answer("GET", "/" + std::string(65536, 'a'))), 414);
    EXPECT_EQ(code_of(answer("GET", "/" + std::string(8100, 'a'))), 414);
    std::string many;
    for (int i = 0; i < 10000; ++i) many += "X-" + std::to_string(i) + ": 1\r\n";
    EXPECT_EQ(code_of(answer("GET", "/", many)), 431);
    EXPECT_EQ(code_of(answer("GET", "/", "X: " + std::string(40000, 'a') + "\r\n")), 431);
    many.clear();
    for (int i = 0; i < 99; ++i) many += "X: 1\r\n";
    EXPECT_EQ(code_of(answer("GET", "/", many)), 431);
    for (const std::string& head :
         {std::string("GET /\r\n\r\n"), std::string("GET / HTTP/2.0\r\n\r\n"), std::string("\r\n\r\n"),
          "GET / HTTP/1.1\r\n" + host() + "no colon\r\n\r\n", "GET / HTTP/1.1\r\n" + host() + " folded: x\r\n\r\n",
          "GET / HTTP/1.1\r\n" + host() + "bad name: x\r\n\r\n", "GET / HTTP/1.1\r\n" + host() + ": x\r\n\r\n",
          "GET /a b HTTP/1.1\r\n" + host() + "\r\n", "GET / HTTP/1.1\n" + host() + "\r\n",
          "GET / HTTP/1.1\r\n" + host() + std::string("X: a\0b\r\n\r\n", 10),
          "GET / HTTP/1.1\r\n" + host() + "X: a\rb\r\n\r\n"}) {
        EXPECT_EQ(code_of(answer_to(head)), 400) << head;
    }
}

TEST_F(ViewServer, ClosesAConnectionWithoutACompleteHead) {
    const auto begin = Clock::now();
    const Connection silent(port_), half(port_), dripping(port_);
    half.send("GET / HTTP/1.1\r\nHost: local");
    std::atomic<bool> stop{false};
    std::thread drip([&] {
        for (int i = 0; i < 200 && !stop; ++i) {
            dripping.send("G");
            std::this_thread::sleep_for(100ms);
        }
    });
    EXPECT_EQ(code_of(half.read_all()), 408);
    EXPECT_EQ(silent.read_all(), "");
    const std::string slow = dripping.read_all();
    EXPECT_TRUE(slow.empty() || code_of(slow) == 408) << slow;
    EXPECT_GT(Clock::now() - begin, 4s);
    EXPECT_LT(Clock::now() - begin, 8s);
    stop = true;
    drip.join();
}

TEST_F(ViewServer, AnswersAThousandAndFirstClient) {
    std::vector<Connection> waiting;
    for (int i = 0; i < 1000; ++i) {
        waiting.emplace_back(port_);
        EXPECT_TRUE(waiting.back().connected()) << i;
        if (i % 2 == 0) waiting.back().send("GET / HT");
        if (i % 5 == 0) waiting.back().end_sending();
    }
    const auto begin = Clock::now();
    EXPECT_EQ(code_of(answer("GET", "/")), 200);
    EXPECT_LT(Clock::now() - begin, 3s);
}

TEST_F(ViewServer, ClosesAConnectionThatNeverReads) {
    // Much more than the system buffers.
    write_file(file_, read_file(file_) + std::string(std::size_t(64) << 20, 'x'));
    std::vector<Connection> lazy;
    for (int i = 0; i < 20; ++i) {
        lazy.emplace_back(port_);
        lazy.back().send("GET /recording HTTP/1.1\r\n" + host() + "\r\n");
    }
    EXPECT_EQ(code_of(answer("GET", "/")), 200);
    std::this_thread::sleep_for(6s);
    EXPECT_LT(lazy[0].read_all().size(), std::size_t(64) << 20);  // the connection was closed early
}

TEST_F(ViewServer, ReportsAMissingOrShrunkFile) {
    const std::string whole = read_file(file_);
    std::filesystem::remove(file_);
    const std::string missing = answer("GET", "/recording");
    EXPECT_EQ(code_of(missing), 404);
    EXPECT_NE(body_of(missing).find("can no longer be read"), missing.npos);
    EXPECT_NE(body_of(missing).find(file_), missing.npos);
    std::filesystem::create_directory(file_);
    EXPECT_EQ(code_of(answer("GET", "/recording")), 404);
    std::filesystem::remove(file_);
    write_file(file_, "");
    EXPECT_EQ(code_of(answer("GET", "/recording")), 404);
    write_file(file_, "something else");
    EXPECT_EQ(body_of(answer("GET", "/recording")), "something else");
    write_file(file_, whole);
    EXPECT_EQ(body_of(answer("GET", "/recording")), whole);
}

TEST_F(ViewServer, RefusesAPortInUse) {
    Program second({"view", file_, "--port", std::to_string(port_)});
    EXPECT_EQ(second.run(), 3);
    EXPECT_NE(second.text().find(std::to_string(port_)), std::string::npos) << second.text();
}

TEST_F(ViewServer, EndsOnSigtermWith143) {
    const Connection waiting(port_);
    program_->send(SIGTERM);
    EXPECT_EQ(program_->wait(), 143);
    program_.reset();
}

TEST(View, WritesOnePageWithoutExternalReferences) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(40), 100));
    Program program({"view", folder / "run.faserec", "--html", folder / "page.html"});
    EXPECT_EQ(program.run(), 0) << program.text();
    const std::string page = read_file(folder / "page.html");
    EXPECT_GT(page.size(), read_file(folder / "run.faserec").size() * 4 / 3);
    EXPECT_EQ(page.find("src=\""), page.npos);
    EXPECT_EQ(page.find("rel=\"stylesheet\""), page.npos);
    EXPECT_NE(page.find("<script id=\"recording\" type=\"application/octet-stream;base64\">RkFTRVJFQ"),
              page.npos);  // FASEREC
    std::size_t scripts = 0;
    for (std::size_t at = 0; (at = page.find("</script", at)) != page.npos; ++at) ++scripts;
    EXPECT_EQ(scripts, 2u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);  // no other file
}

TEST(View, WritesAnAnimation) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(40), 100));
    Program program({"view", folder / "run.faserec", "--glb", folder / "run.glb"});
    EXPECT_EQ(program.run(), 0) << program.text();
    EXPECT_EQ(read_file(folder / "run.glb").substr(0, 4), "glTF");
}

TEST(View, RefusesOtherFilesAndUnwritablePaths) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(5), 10));
    write_file(folder / "text", "hello");
    const auto code = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "view");
        Program program(arguments);
        const int result = program.run();
        EXPECT_NE(program.text().find("fase: error: "), std::string::npos) << program.text();
        return result;
    };
    EXPECT_EQ(code({folder / "text"}), 2);
    EXPECT_EQ(code({folder / "nothing"}), 3);
    EXPECT_EQ(code({folder.path()}), 2);
    EXPECT_EQ(code({"/dev/null"}), 2);
    EXPECT_EQ(code({folder / "run.faserec", "--html", folder.path()}), 3);
    EXPECT_EQ(code({folder / "run.faserec", "--html", folder / "text/page.html"}), 3);
    EXPECT_EQ(code({folder / "run.faserec", "--html", folder / "run.faserec"}), 3);
    EXPECT_EQ(code({folder / "run.faserec", "--html", "/dev/full"}), 3);
    const std::string bytes = read_file(folder / "run.faserec");
    EXPECT_EQ(bytes.substr(0, 7), "FASEREC");
}

TEST(View, RefusesARecordingWithoutACompleteFrameAndWritesNothing) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(3), 4));
    const std::string bytes = read_file(folder / "run.faserec");
    const std::size_t first_frames = bytes.find("FRMS");
    ASSERT_NE(first_frames, std::string::npos);
    const std::string cut = folder / "cut.faserec", page = folder / "page.html", glb = folder / "run.glb";
    std::vector<std::size_t> lengths{1, 7, 8, 15, 16, 17, first_frames, first_frames + 8, first_frames + 20};
    for (std::size_t length = 24; length < first_frames; length += 97) lengths.push_back(length);
    for (const std::size_t length : lengths) {
        write_file(cut, bytes.substr(0, length));
        for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--html", page}, {"--glb", glb}}) {
            std::vector<std::string> arguments{"view", cut};
            arguments.insert(arguments.end(), options.begin(), options.end());
            Program program(arguments);
            EXPECT_EQ(program.run(), 2) << length;
            EXPECT_TRUE(
                program.text().starts_with("fase: error: " + cut + ": found no complete frame; expected at least one"))
                << program.text();
            EXPECT_EQ(std::count(program.text().begin(), program.text().end(), '\n'), 1) << program.text();
        }
    }
    EXPECT_FALSE(std::filesystem::exists(page));
    EXPECT_FALSE(std::filesystem::exists(glb));
}

TEST(View, OpensTheValidPartOfADamagedRecordingAndWarns) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run.faserec", ArtificialRun(40), 200));
    const std::string bytes = read_file(folder / "run.faserec");
    write_file(folder / "cut.faserec", bytes.substr(0, bytes.size() * 2 / 3));
    Program program({"view", folder / "cut.faserec", "--html", folder / "page.html"});
    EXPECT_EQ(program.run(), 0) << program.text();
    EXPECT_NE(program.text().find("fase: warning: "), std::string::npos);
    EXPECT_NE(program.text().find("frames are readable"), std::string::npos) << program.text();
    EXPECT_TRUE(std::filesystem::exists(folder / "page.html"));
}

}  // namespace
}  // namespace fase::cli
