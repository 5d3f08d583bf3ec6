#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""extract.py OUTPUT ROOT HEADER...: writes a test for each example of the headers.

An example stands in a comment between "// @code{.cpp}" and "// @endcode". What it includes, and the
header as users include it, goes to the top; assert() is a check of the test. A header without an
example gets a test that fails.
"""
import pathlib
import re
import sys

output, root, *headers = sys.argv[1:]
includes, tests = [], []
for header in headers:
    path = pathlib.Path(header).relative_to(root).as_posix()
    includes.append(f'#include <spherule/{path}>')
    name = re.sub(r'\W', '_', path)
    text = pathlib.Path(header).read_text(encoding='utf-8')
    examples = list(re.finditer(r'^// @code\{\.cpp\}\n((?://.*\n)+?)// @endcode\n', text, re.M))
    if not examples:
        tests.append(f'TEST(Examples, {name}) {{\n  FAIL() << "{path} has no example";\n}}\n')
    for number, example in enumerate(examples, 1):
        code = re.sub(r'^// ?', '', example[1], flags=re.M)
        includes += re.findall(r'^#include <[^>]+>', code, re.M)
        code = re.sub(r'^#include <[^>]+>', '', code, flags=re.M)
        line = text.count('\n', 0, example.start(1)) + 1
        test = name if len(examples) == 1 else f'{name}_{number}'
        tests.append(f'TEST(Examples, {test}) {{\n#line {line} "{path}"\n{code}}}\n')
pathlib.Path(output).write_text('\n'.join([
    '// SPDX-License-Identifier: BSD-3-Clause', '// Made by tests/examples/extract.py.',
    *dict.fromkeys(includes), '', '#include <gtest/gtest.h>', '', '#include <cassert>', '',
    '#undef assert', '#define assert(condition) EXPECT_TRUE(condition)', '', *tests]), encoding='utf-8')
