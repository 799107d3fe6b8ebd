// SPDX-License-Identifier: BSD-3-Clause
// A program that is killed leaves no partial file, and the shell sees the signal. No test depends
// on time: one output is a pipe without a reader, which holds the program while other outputs are
// written but not yet in place.
#include <sys/stat.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "program.hpp"

namespace rastrum::test::signal_test {
namespace {

class Signals : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    make_pipe("held.npy");
  }
  void make_pipe(const std::string& name) const {
    ASSERT_EQ(::mkfifo(path(name).c_str(), 0666), 0);
  }
  /// Starts a run whose picture is written while its pipe is not yet opened.
  [[nodiscard]] pid_t start_held() const {
    return start("render builtin:sphere --size 64x64 -o p.png --depth d.npy --ids held.npy");
  }
  /// Sends a signal once `count` files exist, the pipe included, and returns the outcome.
  [[nodiscard]] Outcome ended_by(int number, pid_t program, std::size_t count = 3) const {
    EXPECT_TRUE(comes_to(count, program));
    ::kill(program, number);
    const Outcome r = wait(program);
    EXPECT_EQ(r.status, 128 + number);
    return r;
  }
  /// Waits until `count` files exist, the pipe included. False: the program has ended, or it hung
  /// and was killed.
  [[nodiscard]] bool comes_to(std::size_t count, pid_t program) const {
    constexpr std::chrono::seconds kPatience{100};
    const auto end = std::chrono::steady_clock::now() + kPatience;
    siginfo_t info{};
    while (files().size() < count && info.si_pid == 0 && std::chrono::steady_clock::now() < end) {
      ::waitid(P_PID, static_cast<id_t>(program), &info, WEXITED | WNOHANG | WNOWAIT);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (files().size() >= count) return true;
    ::kill(program, SIGKILL);
    return false;
  }
};

TEST_F(Signals, LeaveNoTemporaryAndAreSeenByTheShell) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EQ(ended_by(number, start_held()).err, "");
    EXPECT_EQ(files(), Args("held.npy")) << number;
  }
}

TEST_F(Signals, LeaveTheOldFileAsItWas) {
  write("p.png", "old");
  (void)ended_by(SIGTERM, start_held(), 4);
  EXPECT_EQ(files(), (Args("held.npy p.png")));
  EXPECT_EQ(read("p.png"), "old");
}

TEST_F(Signals, LeaveNoVideo) {
  if (std::system("command -v ffmpeg >/dev/null") != 0)
    GTEST_SKIP() << "ffmpeg is missing (Debian: ffmpeg)";
  std::filesystem::remove(path("held.npy"));
  make_pipe("d0.npy");
  write("p.json", R"({"keys":[{"time":0,"eye":[0,0,4],"target":[0,0,0]},
                              {"time":1,"eye":[0,1,4],"target":[0,0,0]}]})");
  (void)ended_by(
      SIGTERM, start("render builtin:sphere --size 64x64 --path p.json -o v.mp4 --depth d%d.npy"));
  EXPECT_EQ(files(), (Args("d0.npy p.json")));
}

TEST_F(Signals, WhatWasIgnoredStaysIgnored) {
  // Like nohup.
  const Outcome r = shell(
      "trap '' HUP; $RASTRUM render builtin:sphere --size 64x64 -o p.png --ids held.npy & "
      "while [ $(ls -A | wc -l) -lt 2 ]; do :; done; kill -HUP $!; cat held.npy >/dev/null; "
      "wait $!");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(files(), (Args("held.npy p.png")));
}

TEST_F(Signals, NoPipeTakesThePlaceOfAClosedStream) {
  write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl none\nf 1 2 3\n");  // gives a warning
  must("render a.obj --size 64x64 -o beside.png");
  const Outcome r = shell(
      "timeout -s KILL 60 $RASTRUM render a.obj --size 64x64 -o p.png >&- 2>&-; echo $?;"
      "$RASTRUM --version 2>&1 >&- | tail -n 1");
  EXPECT_TRUE(r.out.starts_with("0\n")) << r.out;
  EXPECT_EQ(read("p.png"), read("beside.png"));
  EXPECT_NE(r.out.find("standard output: cannot be written"), std::string::npos) << r.out;
}

TEST_F(Signals, WhatKillLeftIsRemovedByTheNextRun) {
  (void)ended_by(SIGKILL, start_held());
  EXPECT_GE(files().size(), 3U) << "nobody can clean up after SIGKILL";
  must("render builtin:sphere --size 8x8 -o other.png");
  EXPECT_EQ(files(), (Args("held.npy other.png")));
}

TEST_F(Signals, WhatALivingRunWritesIsLeftToIt) {
  const pid_t living = start_held();
  ASSERT_TRUE(comes_to(3, living)) << wait(living).err;
  const std::size_t before = files().size();
  EXPECT_EQ(shell("$RASTRUM render builtin:sphere --size 8x8 -o other.png --quiet").status, 0);
  EXPECT_EQ(files().size(), before + 1);
  std::ifstream(path("held.npy")).ignore(1 << 20);
  int status = -1;
  ASSERT_EQ(::waitpid(living, &status, 0), living);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(files(), (Args("d.npy held.npy other.png p.png")));
}

}  // namespace
}  // namespace rastrum::test::signal_test
