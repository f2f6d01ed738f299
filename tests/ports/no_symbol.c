/* SPDX-License-Identifier: BSD-3-Clause */
/* Judged: refused when it is loaded, naming the missing symbol. A shared library, but not a port.
 */

int attest_unit_v0(void);

__attribute__((visibility("default"))) int attest_unit_v0(void) { return 0; }
