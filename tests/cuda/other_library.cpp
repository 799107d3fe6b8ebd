// A library of device code of another Rastrum: nothing of it may be read but its version.
extern "C" {
struct Other {
  const char* version;
};
const Other* rastrum_cuda_library() noexcept {
  static const Other other{"0.0.1-of-another"};
  return &other;
}
}
