#pragma once
/// An artificial run with everything that a recording can contain: bodies that move, rotate, sleep, wake, jump, and are
/// added and removed.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fase/core/hash.hpp"
#include "fase/record/frame.hpp"
#include "fase/record/recording_writer.hpp"
#include "fase/record/tables.hpp"

namespace fase::record {

/// A temporary folder that is removed with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "fase-record-XXXXXX").string();
        path_ = ::mkdtemp(name.data()) != nullptr ? name : std::string();
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] std::string operator/(const std::string& name) const { return path_ + "/" + name; }
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// Returns the content of a file.
inline std::string read_file(const std::string& name) {
    std::ifstream in(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
/// Writes a file; removes an existing one first, because some file systems flush a truncated file to the disk.
inline void write_file(const std::string& name, const std::string& bytes) {
    std::filesystem::remove(name);
    std::ofstream(name, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Returns a reproducible number in 0 … 1 for three keys.
inline double noise(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    return double(mix_bits(mix_bits(mix_bits(a) + b) + c) >> 11) * 0x1p-53;
}

/// The tables and frames of a run; frame(k) depends only on k.
class ArtificialRun {
public:
    explicit ArtificialRun(std::uint32_t bodies, double origin = 0) : bodies_(bodies), origin_(origin) {}

    [[nodiscard]] static Head head() {
        Head head;
        head.title = "an artificial run";
        head.program = "test";
        head.gravity = {0, -9.81f, 0};
        head.stage_names = {"pairs", "solve"};
        head.counter_names = {"bodies", "awake", "contacts"};
        return head;
    }
    /// Adds all rows that the frames refer to.
    Result<void> add_tables(RecordingWriter& writer) const {
        const RecordedShape box{ShapeKind::Box, {0.5f, 0.5f, 0.5f}, {}, {}};
        const RecordedShape tetrahedron{ShapeKind::Hull,
                                        {},
                                        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
        const RecordedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 2}}};
        if (auto row = writer.add(box); !row) return row.error();
        if (auto row = writer.add(tetrahedron); !row) return row.error();
        if (auto row = writer.add(mesh); !row) return row.error();
        for (std::uint32_t i = 0; i < bodies_; ++i) {
            if (auto row = writer.add(body(i)); !row) return row.error();
            if (auto row = writer.add(collider(i)); !row) return row.error();
        }
        if (bodies_ == 0) return {};
        if (auto row = writer.add(RecordedVisual{0, 0, {{1, 2, 3}, {}}, {1, 2, 3, 255}}); !row) return row.error();
        return {};
    }
    [[nodiscard]] RecordedBody body(std::uint32_t i) const {
        return {i,
                static_cast<std::uint16_t>(1 + i % 3),
                static_cast<std::uint8_t>(i == 0 ? 0 : 2),
                1000ull + i,
                i == 0 ? 0.0f : 2.5f,
                {10, 20, 30, 255},
                i == 0 ? "ground" : ""};
    }
    [[nodiscard]] RecordedCollider collider(std::uint32_t i) const {
        RecordedCollider collider;
        collider.index = i;
        collider.generation = 1;
        collider.body = i;
        collider.shape = i % 2;
        collider.sensor = i % 7 == 3;
        return collider;
    }

    [[nodiscard]] Frame frame(std::uint64_t k) const {
        Frame frame;
        frame.number = k;
        frame.step = k + 1;
        frame.time = double(k + 1) / 60;
        frame.total_ms = float(k) * 0.25f;
        frame.stage_ms = {float(k) * 0.125f, float(k) * 0.0625f};
        frame.counters = {bodies_, k, std::uint64_t(1) << 40};
        for (std::uint32_t i = 0; i < bodies_; ++i) {
            if (!exists(i, k)) continue;
            frame.bodies.push_back(body_at(i, k));
        }
        if (bodies_ >= 4) add_events(frame, k);
        return frame;
    }

private:
    [[nodiscard]] static bool exists(std::uint32_t i, std::uint64_t k) {
        if (i % 11 == 5) return k >= 30;          // is added
        if (i % 13 == 6) return k < 40;           // is removed
        if (i % 17 == 7) return k / 25 % 2 == 0;  // is added and removed again
        return true;
    }
    [[nodiscard]] BodyFrame body_at(std::uint32_t i, std::uint64_t k) const {
        BodyFrame body;
        body.row = i;
        body.kind = static_cast<std::uint8_t>(i == 0 ? 0 : 2);
        const bool rests = i == 0 || (i % 5 == 2 && k / 20 % 2 == 1);
        body.awake = !rests;
        body.quarantined = i % 29 == 28 && k > 50;
        body.island = i == 0 ? 0 : 1 + i - i % (1 + static_cast<std::uint32_t>(k / 10));
        const double t = rests && i != 0 ? double(k / 20 * 20) / 60 : i == 0 ? 0 : double(k) / 60;
        const double jump = i % 19 == 4 ? 1000 * std::floor(double(k) / 15) : 0;
        body.pose.position = {origin_ + 40 * noise(i, 1, 0) + 3 * t + jump, 30 * noise(i, 2, 0) - 4.905 * t * t,
                              -origin_ + 40 * noise(i, 3, 0) + 0.3 * std::sin(9 * t + i)};
        const Vec3d axis = normalized(Vec3d{noise(i, 4, 0) - 0.5, noise(i, 5, 0) - 0.5, noise(i, 6, 0) - 0.5});
        body.pose.rotation = to_float(normalized(rotation_about(axis, (20 * noise(i, 7, 0) - 10) * t)));
        return body;
    }
    void add_events(Frame& frame, std::uint64_t k) const {
        const auto any_collider = [&](std::uint64_t j, std::uint64_t c) {
            return static_cast<std::uint32_t>(noise(k, j, c) * bodies_);
        };
        for (std::uint64_t j = 0; j < k % 4; ++j) {
            frame.contacts_begun.push_back({any_collider(j, 1), any_collider(j, 2)});
            frame.contacts_ended.push_back({any_collider(j, 3), any_collider(j, 4)});
            frame.hits.push_back({any_collider(j, 5),
                                  any_collider(j, 6),
                                  {origin_ + noise(k, j, 7), 2, -origin_},
                                  {0, 1, 0},
                                  3.5f,
                                  0.125f});
        }
        if (k % 8 == 1) frame.sensors_begun.push_back({3, any_collider(0, 8)});
        if (k % 8 == 5) frame.sensors_ended.push_back({3, any_collider(0, 9)});
        ContactFrame contact;
        contact.a = any_collider(0, 10);
        contact.b = any_collider(0, 11);
        contact.normal = {0, 0, 1};
        contact.count = static_cast<int>(k % 5);
        for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
            contact.points[i] = {origin_ + double(i), 1, 2};
            contact.separations[i] = -0.01f * float(i);
            contact.impulses[i] = float(i);
        }
        frame.contacts = {contact, contact};
    }
    std::uint32_t bodies_;
    double origin_;
};

/// Returns the angle between two rotations in degrees.
inline double degrees_between(Quat a, Quat b) {
    const Quatd d = conjugate(to_double(a)) * to_double(b);
    return 2 * std::atan2(length(d.vector()), std::abs(d.w)) * 180 / 3.14159265358979323846;
}

/// Records the frames 0 … count - 1 of a run.
inline Result<void> record_run(const std::string& name, const ArtificialRun& run, std::uint64_t count,
                               const RecorderOptions& options = {}) {
    Result<RecordingWriter> writer = RecordingWriter::create(name, ArtificialRun::head(), options);
    if (!writer) return writer.error();
    if (Result<void> added = run.add_tables(*writer); !added) return added;
    for (std::uint64_t k = 0; k < count; ++k) {
        if (Result<void> added = (*writer).add_frame(run.frame(k)); !added) return added;
    }
    return (*writer).finish();
}

}  // namespace fase::record
