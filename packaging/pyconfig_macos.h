// SPDX-License-Identifier: BSD-3-Clause
// What Python's headers ask of macOS, for a module of the stable ABI (release.sh). Python's own
// pyconfig.h is made on macOS, by its configure script. pymacconfig.h has the other sizes.
#pragma once

#define DOUBLE_IS_LITTLE_ENDIAN_IEEE754 1
#define HAVE_SSIZE_T 1
#define HAVE_STDDEF_H 1
#define HAVE_SYS_STAT_H 1
#define HAVE_SYS_TIME_H 1
#define HAVE_WCHAR_H 1
#define SIZEOF_INT __SIZEOF_INT__
#define SIZEOF_LONG_LONG __SIZEOF_LONG_LONG__
#define SIZEOF_PID_T __SIZEOF_INT__
#define SIZEOF_WCHAR_T __SIZEOF_WCHAR_T__
#define WITH_THREAD 1
