// SPDX-License-Identifier: BSD-3-Clause
// Owner, Shared and FunctionRef, which replace the standard library's in headers.
#include <functional>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include <rastrum/error.hpp>
#include <rastrum/function.hpp>
#include <rastrum/held.hpp>

namespace rastrum::test::held_test {
namespace {

struct Counted {
  explicit Counted(int& ends) : ends_(&ends) {}
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { ++*ends_; }
  int* ends_;
};

TEST(Owner, EndsItsObjectOnce) {
  int first = 0, second = 0;
  {
    Owner<const Counted> a(std::make_unique<Counted>(first));
    Owner<const Counted> b(std::move(a));
    EXPECT_TRUE(a == nullptr);
    EXPECT_EQ(first, 0);
    b = std::make_unique<const Counted>(second);
    EXPECT_EQ(first, 1);
    Owner<const Counted>& same = b;
    b = std::move(same);
    EXPECT_EQ(b->ends_, &second);
  }
  EXPECT_EQ(first, 1);
  EXPECT_EQ(second, 1);
}

TEST(Shared, TheLastCopyEndsTheObject) {
  int ends = 0;
  {
    Shared<const Counted> kept;
    EXPECT_TRUE(kept == nullptr);
    {
      const Shared<const Counted> first(std::make_unique<Counted>(ends));
      Shared<const Counted> second = first;
      kept = second;
      const Shared<const Counted> third = std::move(second);
      EXPECT_TRUE(second == nullptr);
      EXPECT_TRUE(kept == first && third == first);
      kept = Shared<const Counted>(kept);
    }
    EXPECT_EQ(ends, 0);
    EXPECT_EQ(kept->ends_, &ends);
  }
  EXPECT_EQ(ends, 1);
}

struct Other {
  virtual ~Other() = default;
  int number = 3;
};
struct Both : Other, Counted {
  using Counted::Counted;
};
struct CountsInstead {
  int* ends;
  void operator()(const Counted*) const { ++*ends; }
};

TEST(Shared, EndsWhatItKeepsAsTheOwnerDid) {
  int ends = 0, instead = 0;
  { const Shared<const Counted> second_base(std::make_unique<const Both>(ends)); }
  EXPECT_EQ(ends, 1);
  {
    Counted object(ends);
    const Shared<const Counted> shared(
        std::unique_ptr<const Counted, CountsInstead>(&object, {&instead}));
  }
  EXPECT_EQ(instead, 1);
  EXPECT_EQ(ends, 2);
}

TEST(Shared, IsMadeOfASharedPointerAndOfDerivedClasses) {
  struct Derived : Counted {
    using Counted::Counted;
  };
  int ends = 0;
  auto pointer = std::make_shared<const Derived>(ends);
  Shared<const Derived> derived = pointer;
  EXPECT_EQ(derived.get(), pointer.get());
  Shared<const Counted> base = derived;
  pointer = nullptr;
  derived = {};
  EXPECT_EQ(ends, 0);
  EXPECT_EQ(base->ends_, &ends);
  base = {};
  EXPECT_EQ(ends, 1);
  EXPECT_TRUE(Shared<const Counted>(std::unique_ptr<Counted>()) == nullptr);
  EXPECT_TRUE(Shared<const Counted>(std::shared_ptr<Counted>()) == nullptr);
}

int twice(int i) {
  return 2 * i;
}

TEST(FunctionRef, CallsWhatItRefersTo) {
  using Ref = FunctionRef<int(int)>;
  int calls = 0;
  const auto counts = [&](int i) {
    ++calls;
    return i + 1;
  };
  auto changes = [n = 0](int i) mutable { return n += i; };
  std::function<int(int)> function = twice;
  int (*const pointer)(int) = twice;
  EXPECT_EQ(Ref(counts)(1), 2);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(Ref(changes)(3), 3);
  EXPECT_EQ(Ref(changes)(4), 7);
  EXPECT_EQ(Ref(function)(4), 8);
  EXPECT_EQ(Ref(twice)(4), 8);
  EXPECT_EQ(Ref(pointer)(4), 8);
  FunctionRef<void(std::unique_ptr<int>)>([](std::unique_ptr<int> p) { EXPECT_EQ(*p, 3); })(
      std::make_unique<int>(3));
  // None.
  function = nullptr;
  EXPECT_FALSE(Ref());
  EXPECT_FALSE(Ref(function));
  EXPECT_FALSE(Ref(nullptr));
  int (*const none)(int) = nullptr;
  EXPECT_FALSE(Ref(none));
  EXPECT_THROW(static_cast<void>(Ref(none)(1)), Error);
  EXPECT_TRUE(Ref(counts));
}

TEST(Function, KeepsWhatItCalls) {
  using F = Function<int(int)>;
  F kept, copy;
  EXPECT_FALSE(kept);
  EXPECT_FALSE(F(nullptr));
  EXPECT_THROW(static_cast<void>(F()(1)), Error);
  {
    F moved = twice;
    const F to = std::move(moved);
    EXPECT_EQ(to(2), 4);
    EXPECT_EQ(moved(2), 4) << "a move is a copy";
  }
  {
    int more = 5;
    kept = [more, n = 0](int i) mutable { return more + (n += i); };
    copy = kept;
  }
  EXPECT_EQ(kept(1), 6);
  EXPECT_EQ(copy(1), 7);  // shares n
  EXPECT_EQ(F(std::function<int(int)>(twice))(4), 8);
  EXPECT_EQ(F(twice)(4), 8);
  EXPECT_FALSE(F(std::function<int(int)>()));
  EXPECT_EQ(*F(twice).target<int (*)(int)>(), &twice);
  EXPECT_EQ(kept.target<int (*)(int)>(), nullptr);
}

}  // namespace
}  // namespace rastrum::test::held_test
