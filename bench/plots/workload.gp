# SPDX-License-Identifier: BSD-3-Clause
# Three plots of one workload. Variables: folder, workload, terminal (svg or png).
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

# How much faster than FCL's usual set-up is each method?
set output target('ratios')
set title sprintf('%s: speed of a check against fcl-mesh-obbrss (log scale)', workload)
set ylabel 'times faster'
set logscale y
set style fill solid 0.85 noborder
set boxwidth 0.6
set xtics rotate by -20
set rmargin 14
stats data('ratios') using 2 nooutput name 'ratio'
set yrange [(ratio_min < 1 ? ratio_min / 3 : 0.3):ratio_max * 3]
plot data('ratios') using 0:2:xtic(1) with boxes lc rgb '#2a6f97' notitle, \
     '' using 0:($2 * 1.25):(sprintf($2 < 0.1 ? '%.2g' : '%.1f', $2)) with labels notitle
unset logscale
unset yrange
set rmargin -1
set xtics norotate

# How are the times of single checks distributed?
set output target('percentiles')
set title sprintf('%s: time of a single check', workload)
set xlabel 'nanoseconds'
set ylabel 'share of the checks, %'
set logscale x
set format x '%.0e'
set yrange [0:100]
set key outside right
stats data('percentiles') using 1:2 nooutput name 'blocks'
plot for [i = 0:blocks_blocks - 1] data('percentiles') index i using 1:2 with lines lw 2 \
     title columnheader(1)
unset logscale
set format x
unset xlabel
unset yrange

# How many spheres stand for how many triangles?
set output target('spheres')
set title sprintf('%s: triangles and spheres of each part', workload)
set ylabel 'count'
set xtics rotate by -20
set style data histogram
set style histogram clustered gap 1
set yrange [0:*]
set key outside right
plot data('spheres') using 2:xtic(1) lc rgb '#bcbcbc' title 'triangles', \
     '' using 3 lc rgb '#2a6f97' title 'spheres'
