/// Append-only CSV files of measured figures, with the origin of each row.
#include "bench/table_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>

#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::bench {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 26;

std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    out += '"';
    return out;
}

std::string line_of(const std::vector<std::string>& fields) {
    std::string line;
    for (const std::string& one : fields) {
        if (!line.empty()) line += ',';
        line += field(one);
    }
    line += '\n';
    return line;
}

/// Returns the output of a shell command without trailing newlines; "" when the command fails.
std::string output_of(const char* command) {
    FILE* const pipe = ::popen(command, "r");
    if (pipe == nullptr) return {};
    std::array<char, 256> buffer{};
    std::string output;
    while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
    if (::pclose(pipe) != 0) return {};
    while (!output.empty() && output.back() == '\n') output.pop_back();
    return output;
}

}  // namespace

Origin origin_of_figures() {
    Origin origin;
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&now, &utc);
    origin.date = fmt::format("{:04}-{:02}-{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday);
    origin.commit = output_of("git describe --always --dirty --abbrev=10 --exclude '*' 2>/dev/null");
    if (origin.commit.empty()) origin.commit = "unknown";
    std::ifstream processors("/proc/cpuinfo");
    for (std::string line; std::getline(processors, line) && origin.machine.empty();) {
        if (line.rfind("model name", 0) != 0) continue;
        const std::size_t value = line.find(": ");
        if (value != std::string::npos) origin.machine = line.substr(value + 2);
    }
    if (origin.machine.empty()) origin.machine = "unknown processor";
    origin.machine += fmt::format(" x {}", std::thread::hardware_concurrency());
    return origin;
}

Result<void> append_to_table(const std::string& file, const std::vector<std::string>& columns,
                             const std::vector<std::vector<std::string>>& rows) {
    const std::string head = line_of(columns);
    std::string text;
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0) {
        const Result<std::vector<std::byte>> bytes = read_file(file, max_bytes);
        if (!bytes) return bytes.error();
        text.assign(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    }
    if (text.empty()) {
        text = head;
    } else if (text.rfind(head, 0) != 0) {
        return Error{Status::Format, detail::at_line(file, 1),
                     "found other columns; expected " + head.substr(0, head.size() - 1), "choose a new file"};
    }
    if (text.back() != '\n') text += '\n';
    for (const std::vector<std::string>& row : rows) text += line_of(row);
    return write_file(file, std::as_bytes(std::span(text)));
}

}  // namespace fase::bench
