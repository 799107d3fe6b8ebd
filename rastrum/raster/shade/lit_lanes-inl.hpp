// How many lanes the lit shaders take: as many as the machine has, for each is a pixel or a
// triangle. Include it after highway.h, outside of any namespace, once for each instruction set.

#undef RASTRUM_LIT_LANES
#if HWY_MAX_BYTES >= 64
#define RASTRUM_LIT_LANES 16
#elif HWY_MAX_BYTES >= 32
#define RASTRUM_LIT_LANES 8
#else
#define RASTRUM_LIT_LANES 4
#endif
