/// Tests the kinds of files: each magic, short files, the error text.
#include "fase/core/detail/file_kind.hpp"

#include <gtest/gtest.h>

#include "fase/record/format.hpp"
#include "fase/record/trace.hpp"
#include "fase/world/world.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase {
namespace {

FileKind kind_of_text(std::string_view text) { return kind_of(std::as_bytes(std::span(text))); }

TEST(FileKind, KnowsTheMagicBytesOfEachKind) {
    EXPECT_EQ(kind_of_text(""), FileKind::Empty);
    EXPECT_EQ(kind_of_text("hello"), FileKind::Other);
    EXPECT_EQ(kind_of_text("glTF\2"), FileKind::Glb);
    EXPECT_EQ(kind_of_text("{\"a\": 1}"), FileKind::Json);
    EXPECT_EQ(kind_of_text(" \r\n\t[1]"), FileKind::Json);
    EXPECT_EQ(kind_of_text("IWAD...."), FileKind::Wad);
    EXPECT_EQ(kind_of_text("PWAD"), FileKind::Wad);
    EXPECT_EQ(kind_of_text("\x89PNG\r\n\x1a\n"), FileKind::Png);
    EXPECT_EQ(kind_of_text("\xff\xd8\xff\xe0..JFIF"), FileKind::Jpeg);
    EXPECT_EQ(kind_of_text("\x28\xb5\x2f\xfd!"), FileKind::Zstd);
    EXPECT_EQ(kind_of_text("\x1f\x8b\x08"), FileKind::Gzip);
    EXPECT_EQ(kind_of_text(std::string("\0\0\0\0", 4)), FileKind::Other);
}

TEST(FileKind, KnowsTextFormatsByTheirWords) {
    EXPECT_EQ(kind_of_text("{\"asset\": {\"version\": \"2.0\"}}"), FileKind::Gltf);
    EXPECT_EQ(kind_of_text("\xef\xbb\xbf {\"accessors\": []}"), FileKind::Gltf);
    EXPECT_EQ(kind_of_text("[\"asset\"]"), FileKind::Json) << "glTF is an object";
    EXPECT_EQ(kind_of_text("{\n  \"nodes\": []}"), FileKind::Gltf);
    for (const std::string_view text : {"{", "{}", "{\"", "{ \"cases\": []}", "{1}"})
        EXPECT_EQ(kind_of_text(text), FileKind::Json) << text;
    EXPECT_EQ(kind_of_text("{\"pairs\": []}" + std::string(file_kind_bytes, ' ') + "\"asset\""), FileKind::Json);
    EXPECT_EQ(kind_of_text("# Blender\n\nmtllib a.mtl\nv 1 2 3\n"), FileKind::Obj);
    EXPECT_EQ(kind_of_text("# a\r\n\tv\t1 2 3\r\n"), FileKind::Obj);
    for (const std::string_view text : {"v", "victory 1", "40 4\n", "# only a comment", "o\n", "hello v 1 2 3"})
        EXPECT_EQ(kind_of_text(text), FileKind::Other) << text;
    EXPECT_EQ(kind_of_text("<?xml version=\"1.0\"?>\n<!-- a -->\n<mujoco model=\"a\">"), FileKind::Mjcf);
    EXPECT_EQ(kind_of_text("<robot/>"), FileKind::Other);
}

TEST(FileKind, KnowsWhatFaseWrites) {
    EXPECT_EQ(kind_of_text(record::file_magic), FileKind::Recording);
    EXPECT_EQ(kind_of_text(record::trace_magic), FileKind::Trace);
    const Result<World> world = World::create({});
    ASSERT_TRUE(world);
    EXPECT_EQ(kind_of(world->snapshot()), FileKind::Snapshot);
}

TEST(FileKind, ACutMagicIsAnotherKind) {
    for (const std::string_view text : {"FASERE", "AAB", "glT", "IWA", "\x89PNG", "\x1f"})
        EXPECT_EQ(kind_of_text(text), FileKind::Other) << text;
}

TEST(FileKind, ReadsTheStartOfAFile) {
    const record::TemporaryFolder folder;
    record::write_file(folder / "a", "PWAD" + std::string(1000, 'x'));
    const Result<FileKind> kind = kind_of_file(folder / "a");
    ASSERT_TRUE(kind);
    EXPECT_EQ(*kind, FileKind::Wad);
    EXPECT_EQ(kind_of_file(folder / "none").status(), Status::Io);
    EXPECT_EQ(kind_of_file(folder.path()).status(), Status::Format);
}

TEST(FileKind, TheErrorNamesBothKinds) {
    EXPECT_EQ(wrong_kind("a.png", FileKind::Png, "a trace").text(), "a.png: found a PNG image; expected a trace");
    EXPECT_EQ(wrong_kind("a", FileKind::Other, "a trace").text(), "a: found another kind of file; expected a trace");
    EXPECT_EQ(wrong_kind("a", FileKind::Empty, "a trace").status, Status::Format);
}

}  // namespace
}  // namespace fase
