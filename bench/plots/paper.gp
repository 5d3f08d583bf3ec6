# SPDX-License-Identifier: BSD-3-Clause
# The paper's figures 3 and 6 to 8. Variables: folder, terminal (svg or png).
if (terminal eq 'svg') {
  set terminal svg size 900,520 noenhanced font 'sans-serif,14' background 'white'
} else {
  set terminal pngcairo size 900,520 noenhanced font 'sans-serif,11' background 'white'
}
data(what) = sprintf('%s/paper-%s.dat', folder, what)
target(what) = sprintf('%s/paper-%s.%s', folder, what, terminal)
set border 3 lc rgb '#404040'
set tics nomirror
set grid lc rgb '#d8d8d8' lw 1

set output target('figure3')
set title 'Figure 3: the box of a pipe with a bore of 40 mm'
set xlabel 'minimum diameter D of the external spheres, mm'
set ylabel 'not covered by external spheres, %'
set yrange [0:100]
set key bottom right
set arrow 1 from 40, 0 to 40, 100 nohead lc rgb '#a0a0a0' dt 2
plot data('figure3') using 1:2 with linespoints lw 2 pt 7 lc rgb '#2a6f97' \
       title 'reachable (ours)', \
     '' using 1:3 with linespoints lw 2 pt 6 lc rgb '#c1666b' title 'random (the paper)'
unset arrow 1
set yrange [0:*]
set xlabel 'spheres'
set key top right
stats data('courses') using 1:2 nooutput name 'courses'
colors = '#2a6f97 #c1666b #6a994e #9a6fb0'

set output target('figure6')
set title 'Figure 6: greatest distance from a point of the surface to the spheres (D = 100 mm)'
set ylabel 'mm'
set logscale y
set yrange [0.1:*]
plot for [i = 0:courses_blocks - 1] data('courses') index i using 1:2 with lines lw 2 \
       lc rgb word(colors, i + 1) title columnheader(1).', before inflation (after it: none)'
unset logscale
set yrange [0:105]

set output target('figure7')
set title 'Figure 7: share of the solid that the spheres cover'
set ylabel '%'
set key bottom right
plot for [i = 0:courses_blocks - 1] data('courses') index i using 1:4 with lines lw 2 \
       lc rgb word(colors, i + 1) title columnheader(1).', before inflation', \
     for [i = 0:courses_blocks - 1] data('courses') index i using 1:5 with lines lw 2 dt 2 \
       lc rgb word(colors, i + 1) title columnheader(1).', after inflation'
set yrange [0:*]

set output target('figure8')
set title 'Figure 8: volume of the spheres outside of the solid, of its own'
set ylabel '%'
plot for [i = 0:courses_blocks - 1] data('courses') index i using 1:6 with lines lw 2 \
       lc rgb word(colors, i + 1) title columnheader(1).', before inflation', \
     for [i = 0:courses_blocks - 1] data('courses') index i using 1:7 with lines lw 2 dt 2 \
       lc rgb word(colors, i + 1) title columnheader(1).', after inflation'
