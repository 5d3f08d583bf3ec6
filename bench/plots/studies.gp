# SPDX-License-Identifier: BSD-3-Clause
# Plots of what is measured beside a workload. Variables: folder, workload, terminal (svg or png).
if (terminal eq 'svg') {
  set terminal svg size 900,520 noenhanced font 'sans-serif,14' background 'white'
} else {
  set terminal pngcairo size 900,520 noenhanced font 'sans-serif,11' background 'white'
}
data(what) = sprintf('%s/%s-%s.dat', folder, workload, what)
target(what) = sprintf('%s/%s-%s.%s', folder, workload, what, terminal)
set border 3 lc rgb '#404040'
set tics nomirror
set grid y lc rgb '#d8d8d8' lw 1
set key outside right
set style data linespoints
set pointsize 0.7

# What does a check cost with more spheres?
set output target('sizes')
set title sprintf('%s: time of a check with more spheres over the same meshes', workload)
set xlabel 'spheres of all parts together (log scale)'
set ylabel 'nanoseconds a check'
set logscale x
set yrange [0:*]
plot data('sizes') using 1:3 lw 2 lc rgb '#c1121f' title 'one a call, random order', \
     '' using 1:2 lw 2 lc rgb '#2a6f97' title 'one a call', \
     '' using 1:5 lw 2 lc rgb '#2a6f97' dt 2 title 'one a call, free ones', \
     '' using 1:4 lw 2 lc rgb '#61a5c2' title 'many a call'
unset logscale

# What does it cost among few obstacles, beside a flat scan?
set output target('small')
set title sprintf('%s: the robot among few spheres', workload)
set xlabel 'obstacles'
set ylabel 'times as fast as the flat scan (log scale)'
set logscale y 2
set yrange [*:*]
stats data('small') using 1:2 nooutput name 'small'
set yrange [0.5:16]
set xrange [0:110]
shade(i) = int(word('0x61a5c2 0x2a6f97 0xf4a261 0xc1121f', i % 4 + 1))
plot for [i = 0:small_blocks - 1] data('small') index i using 1:($5 / $2) lw 2 \
       lc rgb shade(i) title columnheader(1).', one a call', \
     for [i = 0:small_blocks - 1] '' index i using 1:($5 / $3) lw 2 dt 2 lc rgb shade(i) \
       title columnheader(1).', many', \
     1 with lines lc rgb '#404040' notitle
unset logscale
set xrange [*:*]

# How does the time depend on the distance of two bodies?
set output target('distances')
set title sprintf('%s: torch and workpiece at a distance, median of a query', workload)
set xlabel 'distance / size (log scale)'
set ylabel 'nanoseconds (log scale)'
set logscale xy
set yrange [10:*]
set format y '%.0e'
set format x '%g'
plot data('distances') using 1:7 lw 2 lc rgb '#c1121f' title 'FCL: distance', \
     '' using 1:8 lw 2 lc rgb '#2a6f97' title 'spherule: distance', \
     '' using 1:2 lw 2 dt 2 lc rgb '#c1121f' title 'FCL: collide', \
     '' using 1:3 lw 2 dt 3 lc rgb '#f4a261' title 'FCL: behind boxes', \
     '' using 1:6 lw 2 dt 3 lc rgb '#61a5c2' title 'spherule: confirmed', \
     '' using 1:4 lw 2 dt 2 lc rgb '#2a6f97' title 'spherule: collides'
