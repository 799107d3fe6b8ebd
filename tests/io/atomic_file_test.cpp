// SPDX-License-Identifier: BSD-3-Clause
// Files are whole or absent: with several writers, beside leftovers of others, and when a process
// ends. tests/apps/signal_test.cpp tests this for the program.
#include <rastrum/io.hpp>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

#include <vector>

#include <rastrum/error.hpp>
#include <rastrum/io/files.hpp>

#include "tests/io/files.hpp"
#include "tests/support/refused.hpp"

namespace rastrum::test::atomic_file_test {
namespace {

using io::AtomicFile;
using io::decode_scene;

class AtomicFiles : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path(name);
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& e : std::filesystem::directory_iterator(path("")))
      all.push_back(e.path().filename().string());
    std::ranges::sort(all);
    return all;
  }
  [[nodiscard]] std::string read(const std::string& name) const { return slurp(path(name)); }

  [[nodiscard]] mode_t mode(const std::string& name) const {
    struct stat info {};
    EXPECT_EQ(::stat(path(name).c_str(), &info), 0) << name;
    return info.st_mode & 0777U;
  }
  /// The name of a temporary file as a process of this host makes it.
  [[nodiscard]] static std::string temporary(const std::string& what) {
    char host[65] = {};
    EXPECT_EQ(::gethostname(host, sizeof host - 1), 0);
    return "." + what + "@" + host + ".rastrum-tmp";
  }

  TempFolder folder_;
};
using Names = std::vector<std::string>;

TEST_F(AtomicFiles, AreSeenTogether) {
  AtomicFile a(path("a")), b(path("b"));
  a.write("first", 5);
  b.write("second", 6);
  const auto temporaries = names();
  EXPECT_EQ(temporaries.size(), 2U);
  for (const std::string& name : temporaries) EXPECT_EQ(name[0], '.') << name;
  AtomicFile* const both[] = {&a, &b};
  AtomicFile::commit(both);
  EXPECT_EQ(names(), (Names{"a", "b"}));
  EXPECT_EQ(read("a"), "first");
  EXPECT_EQ(read("b"), "second");
}

TEST_F(AtomicFiles, NoneIsSeenWhereOneFails) {
  folder_.write("a", "old");
  {
    AtomicFile a(path("a")), full("/dev/full");
    a.write("new", 3);
    full.write("x", 1);
    AtomicFile* const both[] = {&a, &full};
    EXPECT_THROW(AtomicFile::commit(both), Error);
  }
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read("a"), "old");
}

TEST_F(AtomicFiles, AnotherWithOurNumberIsNotInTheWay) {
  // Leftovers of the first process of a container, which has the same id in each.
  for (int i = 0; i < 20; ++i)
    folder_.write(temporary("a." + std::to_string(::getpid()) + "." + std::to_string(i)), "left");
  AtomicFile a(path("a"));
  a.write("new", 3);
  a.commit();
  EXPECT_EQ(read("a"), "new");
  EXPECT_EQ(names().size(), 21U);
}

TEST_F(AtomicFiles, OnlyWhatIsLeftIsRemoved) {
  const std::string left_here = temporary("a.1.0");
  // Not every network file system shows the locks of other hosts, so their files stay.
  const std::string elsewhere = ".a.1.0@elsewhere.rastrum-tmp", nobodys = ".a.1.0.rastrum-tmp";
  folder_.write(left_here, "left");
  folder_.write(elsewhere, "maybe in work");
  folder_.write(nobodys, "of whom?");
  folder_.write(".b.tmp", "somebody else's");
  folder_.write("c.rastrum-tmp", "no hidden file");
  AtomicFile living(path("d"));
  living.write("x", 1);
  io::remove_abandoned(path(""));
  const auto left = names();
  EXPECT_EQ(left.size(), 5U);
  EXPECT_FALSE(std::ranges::count(left, left_here));
  living.commit();
  EXPECT_EQ(names(), (Names{nobodys, elsewhere, ".b.tmp", "c.rastrum-tmp", "d"}));
  io::remove_abandoned(path("no-such-folder"));
}

TEST_F(AtomicFiles, LongNamesHaveRoom) {
  const std::string longest(255, 'n');
  AtomicFile file(path(longest));
  file.commit();
  EXPECT_EQ(names(), Names{longest});
}

TEST_F(AtomicFiles, HaveTheModeOfTheFileThatTheyReplace) {
  AtomicFile(path("new")).commit();
  const mode_t usual = mode("new");
  for (const mode_t asked : {0600U, 0640U, 0666U, 0755U, 0200U}) {
    folder_.write("a", "old");
    ASSERT_EQ(::chmod(path("a").c_str(), asked), 0);
    AtomicFile file(path("a"));
    const auto all = names();
    for (const std::string& name : all)
      if (name[0] == '.') {
        EXPECT_EQ(mode(name), asked) << "while it is written";
      }
    file.commit();
    EXPECT_EQ(mode("a"), asked);
  }
  AtomicFile(path("new")).commit();
  EXPECT_EQ(mode("new"), usual);
}

TEST_F(AtomicFiles, DoNotReplaceWhatIsReadOnly) {
  folder_.write("a", "old");
  ASSERT_EQ(::chmod(path("a").c_str(), 0444), 0);
  expect_refused("read-only", Errc::io, [&] { const AtomicFile file(path("a")); });
  EXPECT_EQ(names(), Names{"a"});
  EXPECT_EQ(read("a"), "old");
}

TEST_F(AtomicFiles, FollowLinksAlsoToWhatIsNotThere) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/there", path("relative"));
  std::filesystem::create_symlink(path("relative"), path("absolute"));
  for (const char* link : {"absolute", "relative"}) {
    AtomicFile file(path(link));
    file.write(link, 3);
    file.commit();
    EXPECT_EQ(read("folder/there"), std::string(link, 3));
    EXPECT_TRUE(std::filesystem::is_symlink(path("absolute")));
    EXPECT_TRUE(std::filesystem::is_symlink(path("relative")));
  }
  std::filesystem::create_symlink("missing/there", path("nowhere"));
  EXPECT_NE(io::why_not_writable(path("nowhere")).find("missing"), std::string::npos);
  EXPECT_THROW(AtomicFile{path("nowhere")}, Error);
  std::filesystem::create_symlink("circle", path("circle"));
  EXPECT_THROW(AtomicFile{path("circle")}, Error);
}

TEST_F(AtomicFiles, AProcessThatEndsAbandonsThem) {
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile a(path("a")), b(path("b"));
    a.write("x", 1);
    b.commit();
    io::abandon_files();
    ::_exit(0);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(names(), Names{"b"});
}

TEST_F(AtomicFiles, APipeGetsItsBytesAtTheEnd) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  {
    AtomicFile pipe("/dev/fd/" + std::to_string(ends[1]));
    pipe.write("..cd", 4);
    ASSERT_EQ(std::fseek(pipe.stream(), 0, SEEK_SET), 0) << "it seeks, as OpenEXR wants";
    pipe.write("ab", 2);
    pipe.commit();
  }
  ::close(ends[1]);
  char text[8] = {};
  EXPECT_EQ(::read(ends[0], text, sizeof text), 4);
  EXPECT_STREQ(text, "abcd");
  ::close(ends[0]);
}

TEST(DecodeScene, ReadsFromMemoryWhatItIsToldItIs) {
  const std::string_view text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto bytes = std::as_bytes(std::span(text));
  for (const char* format : {"obj", ".obj", "OBJ"})
    EXPECT_EQ(decode_scene(bytes, format, "somewhere").triangle_count(), 1U) << format;
  EXPECT_THROW((void)decode_scene(bytes, "png", "somewhere"), Error);
  const auto formats = io::scene_formats();
  EXPECT_EQ(std::ranges::count(formats, "obj"), 1);
  const auto as_ply = [&] { (void)decode_scene(bytes, "ply", "somewhere"); };
  EXPECT_TRUE(refusal_of(as_ply, Errc::bad_format).starts_with("somewhere"));
}

TEST(DecodeScene, SaysWhatAWronglyNamedFileBeginsAs) {
  const std::string_view off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* format : {"ply", "stl"})
    expect_refused("it begins as a .off file does", Errc::bad_format,
                   [&] { (void)decode_scene(std::as_bytes(std::span(off)), format, "x"); });
  // The OBJ reader skips lines that it does not know.
  const Scene obj = decode_scene(std::as_bytes(std::span(off)), "obj", "x");
  ASSERT_FALSE(obj.warnings.empty());
  EXPECT_EQ(obj.warnings.back(),
            "x: no triangles as .obj; it begins as a .off file does: give it that name");
}

}  // namespace
}  // namespace rastrum::test::atomic_file_test
