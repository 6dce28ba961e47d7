/// Decodes blocks into frames.
#include "fase/record/recording/block_reader.hpp"

#include "fase/record/format.hpp"

namespace fase::record {
namespace {

constexpr std::int64_t max_quanta = std::int64_t(1) << 52;
bool in_range(std::int64_t quanta) { return quanta >= -max_quanta && quanta <= max_quanta; }

/// Returns whether body flags contain a valid kind.
bool has_valid_kind(std::uint8_t flags) { return flags >> body_kind_shift < 3; }
/// Reads n 16-bit numbers from their two byte planes.
void get_planes(ByteReader& in, std::size_t count, std::vector<std::uint16_t>& words) {
    words.resize(count);
    const auto low = in.get_bytes(count), high = in.get_bytes(count);
    if (in.failed()) return;
    for (std::size_t i = 0; i < count; ++i) {
        words[i] =
            static_cast<std::uint16_t>(std::to_integer<unsigned>(low[i]) | std::to_integer<unsigned>(high[i]) << 8);
    }
}

}  // namespace

Result<BlockReader> BlockReader::open(std::vector<std::byte> raw, const Tables& tables) {
    BlockReader reader(std::move(raw), tables);
    ByteReader in(reader.raw_);
    reader.first_frame_ = in.get<std::uint64_t>();
    reader.frames_ = in.get<std::uint32_t>();
    if (in.failed() || reader.frames_ == 0 || reader.frames_ > max_block_frames ||
        reader.first_frame_ > (std::uint64_t(1) << 53)) {
        return Error{Status::Format, "block", "found an invalid block head", {}};
    }
    reader.offset_ = in.offset();
    reader.rows_.resize(tables.bodies.size());
    return reader;
}

bool BlockReader::read_rows(ByteReader& in, std::size_t min_bytes, bool present) {
    const std::size_t count = in.get_count(min_bytes);
    list_.clear();
    std::uint64_t next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        next += in.get_varuint();
        if (in.failed() || next >= rows_.size() || rows_[next].present != present) return false;
        list_.push_back(static_cast<std::uint32_t>(next++));
    }
    return !in.failed();
}

bool BlockReader::read_positions(ByteReader& in) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int64_t value = 0;
        for (const std::uint32_t row : list_) {
            value += in.get_varint();
            if (in.failed() || !in_range(value)) return false;
            rows_[row].code.position[axis] = value;
        }
    }
    return true;
}

bool BlockReader::read_rotations(ByteReader& in) {
    for (std::size_t i = 0; i < 3; ++i) {
        get_planes(in, list_.size(), words_);
        if (in.failed()) return false;
        for (std::size_t k = 0; k < list_.size(); ++k) {
            RotationCode& rotation = rows_[list_[k]].code.rotation;
            rotation.small[i] = words_[k] & 16383;
            if (i == 0) rotation.largest = static_cast<std::uint8_t>(words_[k] >> 14);
        }
    }
    return true;
}

bool BlockReader::read_added(ByteReader& in) {
    if (!read_rows(in, 12, false)) return false;
    for (const std::uint32_t row : list_) {
        rows_[row] = {};
        rows_[row].present = true;
        rows_[row].changed_in = frames_read_ + 1;
        rows_[row].flags = in.get<std::uint8_t>();
        if (!has_valid_kind(rows_[row].flags)) return false;
    }
    if (!read_positions(in) || !read_rotations(in)) return false;
    for (const std::uint32_t row : list_) rows_[row].island = static_cast<std::uint32_t>(in.get_varuint());
    return !in.failed();
}

bool BlockReader::read_moves(ByteReader& in) {
    if (!read_rows(in, 13, true)) return false;
    for (const std::uint32_t row : list_) {
        Row& state = rows_[row];
        if (state.changed_in == frames_read_ + 1) return false;
        state.changed_in = frames_read_ + 1;
        if (state.moved_in != frames_read_ || frames_read_ == 0) {
            state.step = {};
            state.rotation_step = {};
        }
        state.moved_in = frames_read_ + 1;
    }
    for (std::size_t i = 0; i < 6; ++i) {
        get_planes(in, list_.size(), words_);
        if (in.failed()) return false;
        const std::size_t axis = i % 3;
        for (std::size_t k = 0; k < list_.size(); ++k) {
            Row& state = rows_[list_[k]];
            if (i < 3) {
                state.step[axis] += unzigzag(words_[k]);
                state.code.position[axis] += state.step[axis];
                if (!in_range(state.code.position[axis])) return false;
            } else {
                std::uint16_t& code = state.code.rotation.small[axis];
                const int residual = static_cast<int>(unzigzag(words_[k] & 16383));
                const auto new_code = static_cast<std::uint16_t>((code + state.rotation_step[axis] + residual) & 16383);
                state.rotation_step[axis] = wrap14(int(new_code) - int(code));
                code = new_code;
                if (axis == 0) state.code.rotation.largest = static_cast<std::uint8_t>(words_[k] >> 14);
            }
        }
    }
    return true;
}

bool BlockReader::read_bodies(ByteReader& in) {
    if (!read_rows(in, 1, true)) return false;
    for (const std::uint32_t row : list_) rows_[row].present = false;
    if (!read_added(in)) return false;
    if (!read_rows(in, 2, true)) return false;
    for (const std::uint32_t row : list_) {
        rows_[row].flags = in.get<std::uint8_t>();
        if (!has_valid_kind(rows_[row].flags)) return false;
    }
    if (!read_rows(in, 2, true)) return false;
    for (const std::uint32_t row : list_) rows_[row].island = static_cast<std::uint32_t>(in.get_varuint());
    if (!read_rows(in, 10, true)) return false;
    for (const std::uint32_t row : list_) {
        if (rows_[row].changed_in == frames_read_ + 1) return false;
        rows_[row].changed_in = frames_read_ + 1;
        rows_[row].moved_in = 0;
    }
    return read_positions(in) && read_rotations(in) && read_moves(in);
}

template <class Pair> bool BlockReader::read_pairs(ByteReader& in, std::size_t min_bytes, std::vector<Pair>& pairs) {
    pairs.assign(in.get_count(min_bytes), {});
    const auto colliders = static_cast<std::int64_t>(tables_->colliders.size());
    std::int64_t before = 0;
    for (Pair& pair : pairs) {
        before += in.get_varint();
        if (in.failed() || before < 0 || before >= colliders) return false;
        pair.a = static_cast<std::uint32_t>(before);
    }
    for (Pair& pair : pairs) {
        const std::int64_t b = std::int64_t(pair.a) + in.get_varint();
        if (in.failed() || b < 0 || b >= colliders) return false;
        pair.b = static_cast<std::uint32_t>(b);
    }
    return !in.failed();
}

bool BlockReader::read_points(ByteReader& in, std::size_t count) {
    if (in.failed() || count > in.remaining() / 3) return false;
    points_.resize(count);
    for (int axis = 0; axis < 3; ++axis) {
        std::int64_t value = 0;
        for (Vec3d& point : points_) {
            value += in.get_varint();
            if (in.failed() || !in_range(value)) return false;
            point[axis] = double(value) / tables_->head.quanta_per_metre;
        }
    }
    return true;
}

bool BlockReader::read_hits(ByteReader& in, std::vector<HitFrame>& hits) {
    if (!read_pairs(in, 25, hits) || !read_points(in, hits.size())) return false;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        hits[i].point = points_[i];
        hits[i].normal = in.get_vec3();
    }
    for (HitFrame& hit : hits) hit.speed = in.get<float>();
    for (HitFrame& hit : hits) hit.impulse = in.get<float>();
    return !in.failed();
}

bool BlockReader::read_contacts(ByteReader& in, std::vector<ContactFrame>& contacts) {
    if (!read_pairs(in, 15, contacts)) return false;
    std::size_t points = 0;
    for (ContactFrame& contact : contacts) {
        contact.count = in.get<std::uint8_t>();
        if (contact.count > 4) return false;
        points += static_cast<std::size_t>(contact.count);
    }
    for (ContactFrame& contact : contacts) contact.normal = in.get_vec3();
    if (!read_points(in, points)) return false;
    std::size_t k = 0;
    const auto each_point = [&](const auto& f) {
        for (ContactFrame& contact : contacts) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) f(contact, i);
        }
    };
    each_point([&](ContactFrame& contact, std::size_t i) { contact.points[i] = points_[k++]; });
    each_point([&](ContactFrame& contact, std::size_t i) { contact.separations[i] = in.get<float>(); });
    each_point([&](ContactFrame& contact, std::size_t i) { contact.impulses[i] = in.get<float>(); });
    return !in.failed();
}

Result<void> BlockReader::next(Frame& frame, bool bodies) {
    const auto refuse = [&](const char* problem) {
        return Error{Status::Format, "frame " + std::to_string(first_frame_ + frames_read_), problem, {}};
    };
    if (frames_read_ >= frames_) return refuse("found the end of the block; expected a frame");
    ByteReader outer(std::span<const std::byte>(raw_).subspan(offset_));
    ByteReader in(outer.get_bytes(outer.get<std::uint32_t>()));
    if (outer.failed()) return refuse("found an incomplete frame");
    offset_ += outer.offset();
    if (frames_read_ + 1 == frames_ && outer.remaining() != 0) return refuse("found bytes after the last frame");

    const auto flags = in.get<std::uint8_t>();
    if ((frames_read_ == 0) != ((flags & key_frame) != 0))
        return refuse("found a block whose first frame is not its only key frame");
    frame.number = first_frame_ + frames_read_;
    frame.step = in.get<std::uint64_t>();
    frame.time = in.get<double>();
    frame.total_ms = in.get<float>();
    frame.stage_ms.resize(tables_->head.stage_names.size());
    for (float& ms : frame.stage_ms) ms = in.get<float>();
    frame.counters.resize(tables_->head.counter_names.size());
    for (std::uint64_t& counter : frame.counters) counter = in.get_varuint();
    if (!read_bodies(in)) return refuse("found invalid bodies");
    const bool events = read_pairs(in, 2, frame.contacts_begun) && read_pairs(in, 2, frame.contacts_ended) &&
                        read_pairs(in, 2, frame.sensors_begun) && read_pairs(in, 2, frame.sensors_ended) &&
                        read_hits(in, frame.hits);
    if (!events) return refuse("found invalid events");
    frame.contacts.clear();
    if ((flags & contacts_follow) != 0 && !read_contacts(in, frame.contacts)) {
        return refuse("found invalid contacts");
    }
    if (in.failed() || in.remaining() != 0) return refuse("found a frame whose length does not match its content");
    ++frames_read_;

    frame.bodies.clear();
    if (!bodies) return {};
    for (std::size_t row = 0; row < rows_.size(); ++row) {
        const Row& state = rows_[row];
        if (!state.present) continue;
        frame.bodies.push_back({static_cast<std::uint32_t>(row),
                                static_cast<std::uint8_t>(state.flags >> body_kind_shift & 3),
                                (state.flags & body_awake) != 0, (state.flags & body_quarantined) != 0, state.island,
                                decode_pose(state.code, tables_->head.quanta_per_metre)});
    }
    return {};
}

}  // namespace fase::record
