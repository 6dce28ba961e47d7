/// Encodes frames into blocks.
#include "fase/record/recording/block_writer.hpp"

#include <cmath>

#include "fase/record/format.hpp"

namespace fase::record {
namespace {

std::uint8_t flags_of(const BodyFrame& body) {
    return static_cast<std::uint8_t>((body.awake ? body_awake : 0) | (body.quarantined ? body_quarantined : 0) |
                                     body.kind << body_kind_shift);
}
bool fits_16_bits(std::int64_t value) { return value >= -32768 && value <= 32767; }

/// Writes n numbers as n low bytes, then n high bytes.
template <class Items, class Get> void put_planes(ByteWriter& out, const Items& items, const Get& get) {
    for (const auto& item : items) out.put(static_cast<std::uint8_t>(get(item) & 255));
    for (const auto& item : items) out.put(static_cast<std::uint8_t>(get(item) >> 8));
}

/// Encodes points in quanta, each as the difference to the previous one.
class PointColumns {
public:
    explicit PointColumns(double quanta_per_metre) : quanta_per_metre_(quanta_per_metre) {}
    void add(Vec3d point) {
        for (int axis = 0; axis < 3; ++axis) {
            const double quanta = point[axis] * quanta_per_metre_;
            columns_[static_cast<std::size_t>(axis)].push_back(
                std::isfinite(quanta) && std::abs(quanta) < 0x1p50 ? std::llround(quanta) : 0);
        }
    }
    void put(ByteWriter& out) const {
        for (const auto& column : columns_) {
            std::int64_t previous = 0;
            for (const std::int64_t value : column) {
                out.put_varint(value - previous);
                previous = value;
            }
        }
    }

private:
    double quanta_per_metre_;
    std::array<std::vector<std::int64_t>, 3> columns_;
};

/// Writes the rows of pairs: each a relative to the previous a, each b relative to its a.
template <class Pairs> void put_pair_columns(ByteWriter& out, const Pairs& pairs) {
    std::int64_t previous = 0;
    for (const auto& pair : pairs) {
        out.put_varint(std::int64_t(pair.a) - previous);
        previous = pair.a;
    }
    for (const auto& pair : pairs) out.put_varint(std::int64_t(pair.b) - std::int64_t(pair.a));
}

}  // namespace

Result<void> BlockWriter::check(const Frame& frame) const {
    const auto refuse = [&](const std::string& where, const char* problem) {
        return Error{Status::BadArgument, "step " + std::to_string(frame.step) + ", " + where, problem, {}};
    };
    if (frame.stage_ms.size() != stages_ || frame.counters.size() != counters_) {
        return refuse("report", "found a number of stages or counters that differs from the head of the recording");
    }
    const double limit = std::min(max_position, 0x1p50 / quanta_per_metre_);
    for (std::size_t i = 0; i < frame.bodies.size(); ++i) {
        const BodyFrame& body = frame.bodies[i];
        const auto named = [&] { return "body row " + std::to_string(body.row); };
        if (body.row >= max_rows || (i > 0 && body.row <= frame.bodies[i - 1].row) || body.kind > 2) {
            return refuse(named(), "found rows that are not ascending or an invalid kind");
        }
        const Vec3d at = abs(body.pose.position);
        if (!(at.x <= limit && at.y <= limit && at.z <= limit)) {
            return refuse(named(), "found a position that is not finite or too far away; expected one within 1e9 m");
        }
        if (!(std::abs(length_squared(body.pose.rotation) - 1) < 0.02f)) {
            return refuse(named(), "found a rotation that is not a unit quaternion");
        }
    }
    return {};
}

void BlockWriter::add_change(std::uint32_t row, const PoseCode& code) {
    Row& state = rows_[row];
    if (code == state.code) return;
    const bool moved_in_last_frame = state.moved_in == frames_;
    if (!moved_in_last_frame) {
        state.step = {};
        state.rotation_step = {};
    }
    Move move{row, {}};
    bool fits = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t step = code.position[axis] - state.code.position[axis];
        const std::int64_t residual = step - state.step[axis];
        fits = fits && fits_16_bits(residual);
        move.residuals[axis] = static_cast<std::uint16_t>(zigzag(residual));
        state.step[axis] = step;
        const int rotation_step = wrap14(int(code.rotation.small[axis]) - int(state.code.rotation.small[axis]));
        move.residuals[3 + axis] =
            static_cast<std::uint16_t>(zigzag(wrap14(rotation_step - state.rotation_step[axis])));
        state.rotation_step[axis] = rotation_step;
    }
    move.residuals[3] = static_cast<std::uint16_t>(move.residuals[3] | code.rotation.largest << 14);
    state.code = code;
    if (fits) {
        state.moved_in = frames_ + 1;
        moved_.push_back(move);
    } else {
        state.moved_in = 0;
        jumped_.push_back({row, code});
    }
}

void BlockWriter::classify_changes(const Frame& frame, bool key) {
    removed_.clear();
    flags_changed_.clear();
    island_changed_.clear();
    added_.clear();
    jumped_.clear();
    moved_.clear();
    next_present_.clear();
    if (key) present_.clear();
    std::size_t old = 0;
    for (const BodyFrame& body : frame.bodies) {
        while (old < present_.size() && present_[old] < body.row) removed_.push_back(present_[old++]);
        if (body.row >= rows_.size()) rows_.resize(std::size_t(body.row) + 1);
        Row& state = rows_[body.row];
        const PoseCode code = encode_pose(body.pose, quanta_per_metre_);
        const std::uint8_t flags = flags_of(body);
        if (old < present_.size() && present_[old] == body.row) {
            ++old;
            if (flags != state.flags) flags_changed_.push_back(body.row);
            if (body.island != state.island) island_changed_.push_back(body.row);
            state.flags = flags;
            state.island = body.island;
            add_change(body.row, code);
        } else {
            added_.push_back({body.row, code});
            state = {.code = code, .island = body.island, .flags = flags};
        }
        next_present_.push_back(body.row);
    }
    while (old < present_.size()) removed_.push_back(present_[old++]);
    present_.swap(next_present_);
}

void BlockWriter::put_rows(std::span<const std::uint32_t> rows) {
    std::uint32_t next = 0;
    for (const std::uint32_t row : rows) {
        out_.put_varuint(row - next);
        next = row + 1;
    }
}

void BlockWriter::put_positions(std::span<const Change> changes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int64_t previous = 0;
        for (const Change& change : changes) {
            out_.put_varint(change.code.position[axis] - previous);
            previous = change.code.position[axis];
        }
    }
}

void BlockWriter::put_rotations(std::span<const Change> changes) {
    for (std::size_t i = 0; i < 3; ++i) {
        put_planes(out_, changes, [i](const Change& change) {
            return change.code.rotation.small[i] | (i == 0 ? change.code.rotation.largest << 14 : 0);
        });
    }
}

void BlockWriter::put_pairs(std::span<const ColliderPair> pairs) {
    out_.put_varuint(pairs.size());
    put_pair_columns(out_, pairs);
}

void BlockWriter::put_events(const Frame& frame) {
    put_pairs(frame.contacts_begun);
    put_pairs(frame.contacts_ended);
    put_pairs(frame.sensors_begun);
    put_pairs(frame.sensors_ended);
    out_.put_varuint(frame.hits.size());
    put_pair_columns(out_, frame.hits);
    PointColumns points(quanta_per_metre_);
    for (const HitFrame& hit : frame.hits) points.add(hit.point);
    points.put(out_);
    for (const HitFrame& hit : frame.hits) out_.put_vec3(hit.normal);
    for (const HitFrame& hit : frame.hits) out_.put(hit.speed);
    for (const HitFrame& hit : frame.hits) out_.put(hit.impulse);
}

void BlockWriter::put_contacts(std::span<const ContactFrame> contacts) {
    out_.put_varuint(contacts.size());
    put_pair_columns(out_, contacts);
    PointColumns points(quanta_per_metre_);
    for (const ContactFrame& contact : contacts) out_.put(static_cast<std::uint8_t>(contact.count));
    for (const ContactFrame& contact : contacts) out_.put_vec3(contact.normal);
    const auto each_point = [&](const auto& f) {
        for (const ContactFrame& contact : contacts) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) f(contact, i);
        }
    };
    each_point([&](const ContactFrame& contact, std::size_t i) { points.add(contact.points[i]); });
    points.put(out_);
    each_point([&](const ContactFrame& contact, std::size_t i) { out_.put(contact.separations[i]); });
    each_point([&](const ContactFrame& contact, std::size_t i) { out_.put(contact.impulses[i]); });
}

Result<void> BlockWriter::add(const Frame& frame) {
    if (Result<void> checked = check(frame); !checked) return checked;
    const bool key = frames_ == 0;
    if (key) {
        out_.put(first_frame_);
        out_.put(std::uint32_t{0});  // frames, set by take()
    }
    classify_changes(frame, key);

    const std::size_t begin = out_.size();
    out_.put(std::uint32_t{0});  // size, set below
    out_.put(static_cast<std::uint8_t>((key ? key_frame : 0) | (contacts_ ? contacts_follow : 0)));
    out_.put(frame.step);
    out_.put(frame.time);
    out_.put(frame.total_ms);
    for (const float ms : frame.stage_ms) out_.put(ms);
    for (const std::uint64_t counter : frame.counters) out_.put_varuint(counter & ((std::uint64_t(1) << 53) - 1));

    out_.put_varuint(removed_.size());
    put_rows(removed_);
    const auto rows_of = [&](const auto& changes) {
        scratch_rows_.clear();
        for (const auto& change : changes) scratch_rows_.push_back(change.row);
        return std::span<const std::uint32_t>(scratch_rows_);
    };
    out_.put_varuint(added_.size());
    put_rows(rows_of(added_));
    for (const Change& change : added_) out_.put(rows_[change.row].flags);
    put_positions(added_);
    put_rotations(added_);
    for (const Change& change : added_) out_.put_varuint(rows_[change.row].island);
    out_.put_varuint(flags_changed_.size());
    put_rows(flags_changed_);
    for (const std::uint32_t row : flags_changed_) out_.put(rows_[row].flags);
    out_.put_varuint(island_changed_.size());
    put_rows(island_changed_);
    for (const std::uint32_t row : island_changed_) out_.put_varuint(rows_[row].island);
    out_.put_varuint(jumped_.size());
    put_rows(rows_of(jumped_));
    put_positions(jumped_);
    put_rotations(jumped_);
    out_.put_varuint(moved_.size());
    const std::size_t before_moves = out_.size();
    put_rows(rows_of(moved_));
    for (std::size_t i = 0; i < 6; ++i) {
        put_planes(out_, moved_, [i](const Move& move) { return move.residuals[i]; });
    }
    cost_.moves += moved_.size();
    cost_.move_bytes += out_.size() - before_moves;
    put_events(frame);
    if (contacts_) put_contacts(frame.contacts);
    out_.set_u32(begin, static_cast<std::uint32_t>(out_.size() - begin - 4));
    ++frames_;
    return {};
}

std::span<const std::byte> BlockWriter::take() {
    if (frames_ != 0) out_.set_u32(8, frames_);
    first_frame_ += frames_;
    frames_ = 0;
    taken_.swap(out_);
    out_.clear();
    return taken_.bytes();
}

}  // namespace fase::record
