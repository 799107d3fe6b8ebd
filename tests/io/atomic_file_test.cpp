// Files that are whole or absent: several at once, beside the leavings of others, and at the end of
// a process. The program's side of it is tests/apps/signal_test.cpp.
#include <rastrum/io.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include <rastrum/error.hpp>

#include "tests/io/files.hpp"

namespace rastrum::io::atomic_file_test {
namespace {

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
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test::TempFolder folder_;
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
  // As the first process of every container has: what one of them has left.
  for (int i = 0; i < 20; ++i)
    folder_.write(".a." + std::to_string(::getpid()) + "." + std::to_string(i) + ".rastrum-tmp",
                  "left");
  AtomicFile a(path("a"));
  a.write("new", 3);
  a.commit();
  EXPECT_EQ(read("a"), "new");
  EXPECT_EQ(names().size(), 21U);
}

TEST_F(AtomicFiles, OnlyWhatIsLeftIsRemoved) {
  folder_.write(".a.1.0.rastrum-tmp", "left");
  folder_.write(".b.tmp", "somebody else's");
  folder_.write("c.rastrum-tmp", "no hidden file");
  AtomicFile living(path("d"));
  living.write("x", 1);
  remove_abandoned(path(""));
  const auto left = names();
  EXPECT_EQ(left.size(), 3U);
  EXPECT_FALSE(std::ranges::count(left, ".a.1.0.rastrum-tmp"));
  living.commit();
  EXPECT_EQ(names(), (Names{".b.tmp", "c.rastrum-tmp", "d"}));
  remove_abandoned(path("no-such-folder"));
}

TEST_F(AtomicFiles, LongNamesHaveRoom) {
  const std::string longest(255, 'n');
  AtomicFile file(path(longest));
  file.commit();
  EXPECT_EQ(names(), Names{longest});
}

TEST_F(AtomicFiles, AProcessThatEndsAbandonsThem) {
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile a(path("a")), b(path("b"));
    a.write("x", 1);
    b.commit();
    abandon_files();
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
  const auto formats = scene_formats();
  EXPECT_EQ(std::ranges::count(formats, "obj"), 1);
  try {
    (void)decode_scene(bytes, "ply", "somewhere");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find("somewhere"), 0U) << e.what();
  }
}

TEST(DecodeScene, SaysWhatAWronglyNamedFileBeginsAs) {
  const std::string_view off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const char* format : {"ply", "stl"}) try {
      (void)decode_scene(std::as_bytes(std::span(off)), format, "x");
      FAIL() << format;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("it begins as a .off file does"), std::string::npos)
          << e.what();
    }
  // What the reader of OBJ does not know it leaves out.
  const Scene obj = decode_scene(std::as_bytes(std::span(off)), "obj", "x");
  ASSERT_FALSE(obj.warnings.empty());
  EXPECT_EQ(obj.warnings.back(),
            "x: no triangles as .obj; it begins as a .off file does: give it that name");
}

}  // namespace
}  // namespace rastrum::io::atomic_file_test
