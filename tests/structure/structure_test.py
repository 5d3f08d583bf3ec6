#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The rules of the sources (CONTRIBUTING.md), checked on the sources themselves.

Floors: a folder includes folders before it in FLOORS, its own, and none after it. Between folders of
one floor, the graph of includes has no cycle: types, then modules, then what users call. What a
library keeps to itself stands in neither HEADERS nor SHARED of its CMakeLists.txt. NAME.h in the root
includes what users of the library NAME need.
"""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLOORS = ['base', 'geometry', 'io', 'spheretree', 'simplifier', 'collide', 'robot', 'adapters', 'cli',
          'python', 'tests', 'bench']
LIBRARIES = ['base', 'geometry', 'io/cad', 'io', 'spheretree', 'simplifier', 'collide', 'robot',
             'adapters/fcl', 'adapters/ompl']
LONGEST_FILE = 1000
MOST_PUBLIC_HEADERS = 50
# Headers of third parties (the beginning of their name), and the folders or files that may include them.
EVERYWHERE = re.compile(r'(Eigen/|[a-z_]+$|(dlfcn|fcntl|semaphore|signal|spawn|stdlib|unistd)\.h$|sys/)')
THIRD_PARTIES = {
    'nlohmann/': ['base', 'io', 'simplifier', 'robot', 'cli', 'python', 'tests', 'bench'],
    'tbb/': ['base/threads', 'simplifier', 'tests', 'bench'],
    'tinyxml2.h': ['io', 'robot', 'tests'],
    'zlib.h': ['io', 'tests'],
    'yaml-cpp/': ['robot/formats'],
    'CLI/': ['cli', 'bench'],
    'pybind11/': ['python', 'bench'],
    'fcl/': ['adapters/fcl', 'tests', 'bench'],
    'ccd/': ['adapters/fcl', 'tests', 'bench'],
    'ompl/': ['adapters/ompl', 'tests', 'bench'],
    'immintrin.h': ['collide'],
    'emmintrin.h': ['collide'],
    'cpuid.h': ['collide'],
}
OPENCASCADE = re.compile(r'\w+\.hxx$')
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)
# Users of the installed package, who include nothing of the sources.
OUTSIDE = ('tests/consumer/', 'examples/')
LICENCE = 'SPDX-License-Identifier: BSD-3-Clause'
SOURCE = re.compile(r'(\.(h|cpp|cmake|in|py|pyi|js|css|sh)|/run|/install|CMakeLists\.txt)$')


def within(path, folder):
    return path == folder or path.startswith(folder + '/') or path.startswith(folder + '.')


def library_of(path):
    return next((library for library in LIBRARIES if within(path, library)), None)


def floor_of(path):
    top = path.split('/')[0].removesuffix('.h')
    return FLOORS.index(top) if top in FLOORS else None


def listed_headers(cmake):
    """What spherule_library() declares: (HEADERS, SHARED)."""
    lists = {'HEADERS': set(), 'SHARED': set()}
    for call in re.findall(r'\n *spherule_library\(([^)]*)\)', '\n' + cmake):
        key = None
        for word in call.split()[1:]:
            if word.isupper():
                key = word
            elif key in lists:
                lists[key].add(word)
    return lists['HEADERS'], lists['SHARED']


def cycle_in(graph):
    """A cycle of a graph {node: {node}} as a list of nodes, or None."""
    done, path = set(), []

    def visit(node):
        if node in path:
            return path[path.index(node):] + [node]
        if node in done:
            return None
        path.append(node)
        for other in sorted(graph.get(node, ())):
            found = visit(other)
            if found:
                return found
        path.pop()
        done.add(node)
        return None

    for node in sorted(graph):
        found = visit(node)
        if found:
            return found
    return None


def problems_of(files, cmakes):
    """The violations in sources {path: text} with the CMakeLists.txt of libraries {folder: text}."""
    problems = []
    headers = {library: listed_headers(text) for library, text in cmakes.items()}

    def is_listed(path, library, lists):
        name = path[len(library) + 1:] if '/' in path else '${PROJECT_SOURCE_DIR}/' + path
        return any(name in names for names in lists)

    graph = {}
    for path, text in files.items():
        lines = text.split('\n')
        if LICENCE not in lines[1 if lines[0].startswith('#!') else 0]:
            problems.append(f'{path}: the licence line is missing')
        if len(lines) > LONGEST_FILE:
            problems.append(f'{path}: is longer than {LONGEST_FILE} lines')
        if not path.endswith(('.h', '.cpp')):
            continue
        if path.endswith('.h') and '#pragma once' not in lines:
            problems.append(f'{path}: #pragma once is missing')
        own = path[:-4] + '.h'
        includes = INCLUDE.findall(text)
        if path.endswith('.cpp') and own in files and (not includes or includes[0][1] != own):
            problems.append(f'{path}: does not include {own} before all others')
        if path.startswith(OUTSIDE):
            continue
        library, floor = library_of(path), floor_of(path)
        if floor is None:
            problems.append(f'{path}: stands on no floor')
            continue
        for mark, target in includes:
            if mark == '<':
                allowed = next((where for start, where in THIRD_PARTIES.items()
                                if target.startswith(start)), None)
                if OPENCASCADE.match(target):
                    allowed = ['io/cad', 'tests']
                if allowed is None and (EVERYWHERE.match(target) or path.startswith(('tests', 'bench'))):
                    continue
                if not any(within(path, place) for place in allowed or ()):
                    problems.append(f'{path}: may not include <{target}>')
                continue
            to = library_of(target)
            if floor_of(target) is None or floor_of(target) > floor:
                problems.append(f'{path}: may not include {target}, which is above it')
                continue
            ours, theirs = (str(pathlib.PurePath(p).parent) for p in (path, target))
            if ours != theirs:
                graph.setdefault(ours, set()).add(theirs)
            # Tests, benchmarks and the Python module may look into libraries.
            if to and to != library and floor < FLOORS.index('python') and to in headers:
                if not is_listed(target, to, headers[to]):
                    problems.append(f'{path}: {target} is private to {to}')
            if library and is_listed(path, library, headers.get(library, ((),))[:1]):
                if to and not is_listed(target, to, headers.get(to, ((),))[:1]):
                    problems.append(f'{path}: is installed, {target} is not')
    found = cycle_in(graph)
    if found:
        problems.append('folders include each other: ' + ' -> '.join(found))
    return problems


def sources():
    names = subprocess.run(['git', 'ls-files', '-co', '--exclude-standard'], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split('\n')
    names = [name for name in names if SOURCE.search(name) and (ROOT / name).is_file()]
    return {name: (ROOT / name).read_text(encoding='utf-8') for name in names}


class Structure(unittest.TestCase):
    def test_sources_keep_the_rules(self):
        files = sources()
        self.assertGreater(len(files), 300)
        cmakes = {library: files[library + '/CMakeLists.txt'] for library in LIBRARIES
                  if library + '/CMakeLists.txt' in files}
        self.assertEqual([], problems_of(files, cmakes))

    def test_public_headers_are_few(self):
        files = sources()
        headers = [name for library in LIBRARIES
                   for name in listed_headers(files[library + '/CMakeLists.txt'])[0]]
        self.assertGreater(len(headers), 20)
        self.assertLessEqual(len(headers), MOST_PUBLIC_HEADERS)

    # In comments and in the pages: a citation outlives the file easily.
    def test_cited_files_exist(self):
        texts = sources()
        names = {pathlib.PurePath(name).name for name in texts}
        for page in ROOT.glob('**/README.md'):
            if 'build' not in page.parts:
                texts[str(page.relative_to(ROOT))] = page.read_text(encoding='utf-8')
        missing = set()
        for name, text in texts.items():
            if name.startswith('tests/structure') or not name.endswith(('.h', '.cpp', '.md')):
                continue
            cited = re.findall(r'//[^"<\n]*?\b(\w+\.(?:h|cpp))\b' if name[-3:] != '.md' else
                               r'`[\w./-]*?\b(\w+\.(?:h|cpp|py|js))`', text)
            missing.update(f'{name}: {file}' for file in cited if file not in names)
        self.assertEqual(set(), missing)

    def test_violations_are_found(self):
        start = '// ' + LICENCE + '\n#pragma once\n'
        cmakes = {'geometry': 'spherule_library(geometry\n HEADERS a.h\n SHARED b.h\n SOURCES c.cpp)',
                  'collide': 'spherule_library(collide\n HEADERS a.h\n SOURCES d.cpp)'}

        def verdict(path, *includes):
            text = start + ''.join(f'#include {include}\n' for include in includes)
            return problems_of({path: text}, cmakes)

        for path, include in [('collide/x.h', '"geometry/a.h"'), ('collide/x.h', '"geometry/b.h"'),
                              ('collide/x.h', '<vector>'), ('collide/x.h', '<Eigen/Core>'),
                              ('tests/x.h', '"geometry/p.h"'), ('io/cad/x.h', '<STEPControl.hxx>')]:
            self.assertEqual([], verdict(path, include), include)
        for path, include in [('geometry/x.h', '"collide/a.h"'), ('collide/x.h', '"geometry/p.h"'),
                              ('collide/a.h', '"geometry/b.h"'), ('collide/x.h', '"tests/support/a.h"'),
                              ('collide/x.h', '<tbb/parallel_for.h>'), ('cli/x.h', '"bench/a.h"'),
                              ('collide/x.h', '"a.h"'), ('robot/x.h', '<TopoDS.hxx>')]:
            self.assertEqual(1, len(verdict(path, include)), f'{path} {include}')
        self.assertEqual(1, len(problems_of({'collide/x.h': '#pragma once\n'}, {})))
        self.assertEqual(1, len(problems_of({'collide/x.h': start + '\n' * 1000}, {})))
        mutual = {'collide/r/x.h': start + '#include "collide/s/y.h"\n',
                  'collide/s/z.h': start + '#include "collide/r/w.h"\n'}
        self.assertEqual(1, len(problems_of(mutual, {})))


class Guarantee(unittest.TestCase):
    page = (ROOT / 'docs/guarantee.md').read_text(encoding='utf-8')

    def sections(self):
        parts = re.split(r'^(?=### G\d+: |## )', self.page, flags=re.M)
        return {part[4:].split(':')[0]: part for part in parts if part.startswith('### G')}

    def test_proofs_and_tests_exist(self):
        self.assertEqual(9, len(self.sections()))
        for number, text in self.sections().items():
            proofs = [name for line in re.findall(r'^- Proof: .*', text, re.M)
                      for name in re.findall(r'`([^`]+)`', line)]
            tests = re.findall(r'^- Test: `(\w+)\.(\w+)` in `([^`]+)`$', text, re.M)
            self.assertTrue(proofs and tests, number)
            self.assertEqual(len(re.findall(r'^- Test:', text, re.M)), len(tests), number)
            for name in proofs:
                self.assertRegex((ROOT / name).read_text(encoding='utf-8'), rf'\b{number}\b', name)
            for suite, name, file in tests:
                self.assertRegex((ROOT / file).read_text(encoding='utf-8'),
                                 rf'\bTEST(_F|_P)?\({suite},\s*{name}\)')

    def test_cited_numbers_are_defined(self):
        cited = {number for name, text in sources().items() if name.endswith(('.h', '.cpp'))
                 and not name.startswith('tests/') for number in re.findall(r'\bG[1-9]\d?\b', text)}
        self.assertGreater(len(cited), 5)
        self.assertEqual(set(), cited - set(self.sections()))

    def test_the_code_of_the_guide_is_that_of_the_example(self):
        guide = (ROOT / 'docs/cpp_robot.md').read_text(encoding='utf-8')
        example = (ROOT / 'examples/check_motion/main.cpp').read_text(encoding='utf-8')
        code = guide.split('```cpp\n')[1].split('```')[0]
        self.assertEqual(example[example.index('#include'):], code)


if __name__ == '__main__':
    sys.exit(unittest.main())
