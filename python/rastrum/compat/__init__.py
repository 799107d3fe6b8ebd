# SPDX-License-Identifier: BSD-3-Clause
"""Stand-ins for packages that need OpenGL."""
