/// Checks of input files: what a command reads, and which command reads a file of another kind.
#include "cli/common/input.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fase/record/generate_trace.hpp"

namespace fase::cli {
namespace {

/// What to do with a file of that kind, as the end of an error; "" for unknown kinds.
std::string advice_for(FileKind kind, const std::string& path) {
    const std::string file = shell_word(path);
    switch (kind) {
        case FileKind::Recording: return fmt::format(": use `fase view {}`", file);
        case FileKind::Trace: return fmt::format(": use `fase pairs {}`", file);
        case FileKind::Glb:
        case FileKind::Gltf: return fmt::format(": use `fase run {}`", file);
        case FileKind::Wad:
        case FileKind::Obj: return fmt::format(": use `fase level {}`", file);
        case FileKind::Png: return fmt::format(": use `fase atlas {} -o NAME`", file);
        case FileKind::Json: return fmt::format(": use `fase distance {}` if it lists pairs of shapes", file);
        case FileKind::Snapshot: return "; only World::restore() of the library reads snapshots";
        case FileKind::Mjcf: return "; no command reads MuJoCo models yet";
        case FileKind::Jpeg: return "; convert it to PNG for `fase atlas`";
        case FileKind::Zstd:
        case FileKind::Gzip: return "; unpack it first";
        case FileKind::Other:
        case FileKind::Empty: break;
    }
    return {};
}

bool reads_traces_only(const InputKinds& expected) {
    return expected.kinds.size() == 1 && expected.kinds[0] == FileKind::Trace;
}

bool is_trace_kind(const std::string& name) {
    const auto kinds = record::trace_kinds();
    return std::any_of(kinds.begin(), kinds.end(), [&](const record::TraceKind& kind) { return kind.name == name; });
}

}  // namespace

Result<FileKind> check_input(const std::string& path, const InputKinds& expected) {
    const Result<FileKind> kind = kind_of_file(path);
    if (kind.status() == Status::Io && reads_traces_only(expected) && is_trace_kind(path)) {
        Error error = kind.error();
        error.remedy = fmt::format("'fase generate {} -o {}.aabt' writes such a trace", path, path);
        return error;
    }
    if (!kind || std::find(expected.kinds.begin(), expected.kinds.end(), *kind) != expected.kinds.end()) return kind;
    return Error{Status::Format,
                 path,
                 fmt::format("found {}; `fase {}` reads {}{}", name_of(*kind), expected.command, expected.reads,
                             advice_for(*kind, path)),
                 {}};
}

std::string shell_word(const std::string& text) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+,:@%=-";
    if (!text.empty() && text[0] != '-' && text.find_first_not_of(plain) == std::string::npos) return text;
    std::string word = text.starts_with('-') ? "./'" : "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

}  // namespace fase::cli
