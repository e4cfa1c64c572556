# SPDX-License-Identifier: Apache-2.0
"""When a command counts as hung: many times what a slow, busy machine takes for any of them."""

HANG_LIMIT = 1000  # seconds
