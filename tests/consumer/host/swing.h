/* A library made with massspring, whose users see nothing of it. SPDX-License-Identifier: MIT */
int swing_version(void);
