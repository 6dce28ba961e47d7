/// Reads, validates and writes box traces.
#include "fase/record/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::record {
namespace {

constexpr std::uint64_t head_size = 16, box_size = 24;
constexpr std::size_t block_boxes = 16384;  // read per call
constexpr std::uint8_t known_flags = trace_static | trace_asleep;
constexpr std::array<std::string_view, 6> number_names{"lower x", "lower y", "lower z",
                                                       "upper x", "upper y", "upper z"};

constexpr std::uint64_t padded(std::uint64_t boxes) { return (boxes + 3) / 4 * 4; }

/// The first invalid number of a box.
struct Fault {
    std::size_t number = 0;
    std::string problem;  ///< "" if the box is valid
};

Fault fault_of(const Aabb& box) {
    const std::array<float, 6> numbers{box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
    for (std::size_t i = 0; i < 6; ++i)
        if (std::isnan(numbers[i])) return {i, fmt::format("found NaN as {}; expected a number", number_names[i])};
    for (std::size_t i = 0; i < 3; ++i) {
        if (numbers[i] > numbers[i + 3])
            return {i, fmt::format("found {} {} above {} {}; expected lower <= upper", number_names[i], numbers[i],
                                   number_names[i + 3], numbers[i + 3])};
        if (numbers[i] == Aabb::infinity || numbers[i + 3] == -Aabb::infinity)
            return {i, fmt::format("found {} {} and {} {}; expected a box that is not at infinity", number_names[i],
                                   numbers[i], number_names[i + 3], numbers[i + 3])};
    }
    return {};
}

}  // namespace

Error TraceReader::format_error(std::uint64_t offset, std::string problem, std::string remedy) const {
    return {Status::Format, detail::at_byte(path(), offset), std::move(problem), std::move(remedy)};
}

Error TraceReader::body_error(std::uint32_t body, std::size_t number, const std::string& problem) const {
    return format_error(offset_of(frame_, body) + number * 4,
                        fmt::format("frame {}, body {}: {}", frame_, body, problem));
}

std::uint64_t TraceReader::offset_of(std::uint32_t frame, std::uint32_t body) const {
    return head_bytes_ + (std::uint64_t(frame) * boxes() + body) * box_size;
}

Result<TraceReader> TraceReader::open(const std::string& name) {
    Result<InputFile> file = InputFile::open(name);
    if (!file) return file.error();
    TraceReader reader(*std::move(file));
    if (Result<void> read = reader.read_head(); !read) return read.error();
    return reader;
}

Result<void> TraceReader::read_head() {
    const std::uint64_t size = file_.size();
    std::array<std::byte, head_size> head{};
    const auto begin = std::span(head).first(static_cast<std::size_t>(std::min(size, head_size)));
    if (Result<void> read = file_.read(0, begin); !read) return read;
    const auto letters = std::as_bytes(std::span(trace_magic));
    const std::size_t known = std::min(begin.size(), letters.size());
    if (begin.empty() ||
        !std::equal(begin.begin(), begin.begin() + static_cast<std::ptrdiff_t>(known), letters.begin()))
        return wrong_kind(path(), kind_of(begin), "a trace, which begins with AABT");
    if (size < head_size)
        return format_error(size, fmt::format("found {} bytes; expected a head of {}", size, head_size));

    ByteReader numbers(std::span<const std::byte>(head).subspan(4));
    const auto version = numbers.get<std::uint32_t>(), boxes = numbers.get<std::uint32_t>();
    frames_ = numbers.get<std::uint32_t>();
    if (version != trace_version)
        return format_error(4, fmt::format("found version {}; this program reads {}", version, trace_version));
    if (boxes == 0) return format_error(8, "found 0 boxes; expected at least 1");
    if (frames_ == 0) return format_error(12, "found 0 frames; expected at least 1", "the trace may be unfinished");

    // No overflow: there are fewer than 2^32 boxes, so a frame is below 2^37 bytes, and a division counts the frames.
    head_bytes_ = head_size + padded(boxes);
    const std::uint64_t frame_bytes = boxes * box_size;
    if (size < head_bytes_)
        return format_error(
            head_size, fmt::format("found {} bytes of flags; expected {}, a byte per box", size - head_size, boxes));
    const std::uint64_t whole = (size - head_bytes_) / frame_bytes, rest = (size - head_bytes_) % frame_bytes;
    if (whole < frames_) {
        return format_error(size,
                            fmt::format("frame {}, body {}: found the end of the file after {} frames and {} bytes; "
                                        "expected {} frames of {} bytes",
                                        whole, rest / box_size, whole, rest, frames_, frame_bytes));
    }
    if (whole > frames_ || rest != 0) {
        const std::uint64_t end = head_bytes_ + frames_ * frame_bytes;
        return format_error(
            end, fmt::format("found {} bytes after the last of {} frames; expected none", size - end, frames_));
    }

    std::vector<std::byte> flags(static_cast<std::size_t>(head_bytes_ - head_size));
    if (Result<void> read = file_.read(head_size, flags); !read) return read;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        const auto flag = std::to_integer<unsigned>(flags[i]);
        if (i < boxes && (flag & ~unsigned(known_flags)) != 0)
            return format_error(head_size + i,
                                fmt::format("body {}: found flags {}; expected 0 to {}", i, flag, known_flags));
        if (i >= boxes && flag != 0)
            return format_error(head_size + i, fmt::format("found {} after the flags; expected 0", flag));
    }
    flags_.resize(boxes);
    for (std::size_t i = 0; i < boxes; ++i) flags_[i] = std::to_integer<std::uint8_t>(flags[i]);
    return {};
}

Result<bool> TraceReader::next(std::vector<Aabb>& out) {
    out.clear();
    if (frame_ == frames_) return false;
    out.reserve(boxes());
    block_.resize(std::min(boxes(), block_boxes) * box_size);
    std::size_t statics = 0;  // so far in this frame
    for (std::size_t first = 0; first < boxes(); first += block_boxes) {
        const std::size_t count = std::min(block_boxes, boxes() - first);
        const std::span<std::byte> bytes = std::span(block_).first(count * box_size);
        if (Result<void> read = file_.read(offset_of(frame_, static_cast<std::uint32_t>(first)), bytes); !read) {
            out.clear();
            return read.error();
        }
        ByteReader numbers(bytes);
        for (std::size_t i = first; i < first + count; ++i) {
            Aabb box;
            for (Vec3* corner : {&box.lo, &box.hi})
                *corner = {numbers.get<float>(), numbers.get<float>(), numbers.get<float>()};
            const auto body = static_cast<std::uint32_t>(i);
            const bool is_static = (flags_[i] & trace_static) != 0;
            if (const Fault fault = fault_of(box); !fault.problem.empty()) {
                out.clear();
                return body_error(body, fault.number, fault.problem);
            }
            if (is_static && frame_ == 0) {
                if (first_static_.size() == statics) first_static_.push_back(box);
            } else if (is_static && !(statics < first_static_.size() && first_static_[statics] == box)) {
                out.clear();
                return body_error(body, 0, "found a static body whose box moved; expected the box of the first frame");
            }
            statics += is_static ? 1 : 0;
            out.push_back(box);
        }
    }
    ++frame_;
    return true;
}

std::vector<MotionState> TraceReader::motion_states() const {
    std::vector<MotionState> states;
    states.reserve(flags_.size());
    for (const std::uint8_t flag : flags_) {
        states.push_back((flag & trace_static) != 0   ? MotionState::Static
                         : (flag & trace_asleep) != 0 ? MotionState::Asleep
                                                      : MotionState::Awake);
    }
    return states;
}

Result<TraceWriter> TraceWriter::create(const std::string& name, std::size_t boxes) {
    if (boxes == 0 || boxes >= std::numeric_limits<std::uint32_t>::max())
        return Error{Status::BadArgument, name, fmt::format("found {} boxes; expected 1 to 2^32 - 2", boxes), {}};
    Result<OutputFile> file = OutputFile::create(name);
    if (!file) return file.error();
    if (file->is_stream())
        return Error{
            Status::Io, name, "found a device or a pipe; expected a file, because its head is written last", {}};
    TraceWriter writer(*std::move(file), boxes);
    ByteWriter head;
    head.put_letters(trace_magic);
    head.put(trace_version);
    head.put(static_cast<std::uint32_t>(boxes));
    head.put(std::uint32_t{0});
    std::vector<std::byte> bytes(head.bytes().begin(), head.bytes().end());
    bytes.resize(static_cast<std::size_t>(head_size + padded(boxes)));
    if (Result<void> written = writer.file_.append(bytes); !written) return written.error();
    return writer;
}

Result<void> TraceWriter::add_frame(std::span<const Aabb> boxes) {
    if (!state_) return state_;
    if (boxes.size() != boxes_)
        return Error{Status::BadArgument,
                     fmt::format("frame {}", frames_),
                     fmt::format("found {} boxes; expected {} in every frame", boxes.size(), boxes_),
                     {}};
    if (frames_ == std::numeric_limits<std::uint32_t>::max())
        return Error{Status::Capacity, path(), "found too many frames; expected at most 2^32 - 1", {}};
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (const Fault fault = fault_of(boxes[i]); !fault.problem.empty())
            return Error{Status::BadArgument, fmt::format("frame {}, body {}", frames_, i), fault.problem, {}};
    }
    frame_bytes_.clear();
    for (const Aabb& box : boxes) {
        frame_bytes_.put_vec3(box.lo);
        frame_bytes_.put_vec3(box.hi);
    }
    if (const Result<void> written = file_.append(frame_bytes_.bytes()); !written) {
        Error error = written.error();
        error.problem += fmt::format("; wrote {} frames, {} bytes", frames_, file_.bytes());
        state_ = error;
        return error;
    }
    if (frames_ == 0) {
        first_.assign(boxes.begin(), boxes.end());
        moved_.assign(boxes_, 0);
    } else {
        for (std::size_t i = 0; i < boxes_; ++i)
            if (!(boxes[i] == first_[i])) moved_[i] = 1;
    }
    ++frames_;
    return {};
}

Result<void> TraceWriter::write_head(std::span<const std::uint8_t> flags) {
    if (frames_ == 0) return Error{Status::BadArgument, path(), "found no frame; expected at least 1", {}};
    if (flags.size() != boxes_)
        return Error{Status::BadArgument, path(), fmt::format("found {} flags; expected {}", flags.size(), boxes_), {}};
    for (std::size_t i = 0; i < boxes_; ++i) {
        if ((flags[i] & ~unsigned(known_flags)) != 0)
            return Error{Status::BadArgument,
                         fmt::format("body {}", i),
                         fmt::format("found flags {}; expected 0 to {}", flags[i], known_flags),
                         {}};
        if ((flags[i] & trace_static) != 0 && moved(i))
            return Error{
                Status::BadArgument, fmt::format("body {}", i), "found the static flag of a body whose box moved", {}};
    }
    ByteWriter count;
    count.put(frames_);
    if (Result<void> written = file_.overwrite(head_size, std::as_bytes(flags)); !written) return written;
    return file_.overwrite(head_size - 4, count.bytes());
}

Result<void> TraceWriter::finish(std::span<const std::uint8_t> flags, bool durable) {
    if (!state_) {
        (void)leave_part(flags);
        return state_;
    }
    if (Result<void> written = write_head(flags); !written) return written;
    return file_.complete(durable);
}

Result<void> TraceWriter::leave_part(std::span<const std::uint8_t> flags) {
    if (frames_ > 0) return write_head(flags);
    file_.discard();
    return {};
}

}  // namespace fase::record
