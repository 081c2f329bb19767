;; The arithmetic of a network in 128-bit SIMD, for points that lie side by side.
;;
;; A layer's activations are a matrix of float32 with a row for each unit and a column for each
;; point; `points` is a multiple of 16. Addresses are in bytes. kernel_plain.js computes the same
;; without SIMD. Built by `npm run kernel` into kernel_wasm.js.
(module
  (memory (import "nisp" "memory") 1)

  ;; y = w x + b. w: rows * columns, row by row; b: rows; x: columns * points; y: rows * points.
  ;; `rows` is even. Two rows and 16 points at a time: eight sums stay in registers.
  (func (export "linear")
    (param $w i32) (param $b i32) (param $x i32) (param $y i32)
    (param $rows i32) (param $columns i32) (param $points i32)
    (local $stride i32) (local $width i32) (local $at i32) (local $left i32)
    (local $wp i32) (local $wq i32) (local $xp i32) (local $yp i32)
    (local $u v128) (local $v v128) (local $t v128)
    (local $a0 v128) (local $a1 v128) (local $a2 v128) (local $a3 v128)
    (local $c0 v128) (local $c1 v128) (local $c2 v128) (local $c3 v128)
    (local.set $stride (i32.shl (local.get $points) (i32.const 2)))
    (local.set $width (i32.shl (local.get $columns) (i32.const 2)))
    (loop $next_rows
      (local.set $at (i32.const 0))
      (loop $next_points
        (local.set $a0 (v128.load32_splat (local.get $b)))
        (local.set $a1 (local.get $a0))
        (local.set $a2 (local.get $a0))
        (local.set $a3 (local.get $a0))
        (local.set $c0 (v128.load32_splat offset=4 (local.get $b)))
        (local.set $c1 (local.get $c0))
        (local.set $c2 (local.get $c0))
        (local.set $c3 (local.get $c0))
        (local.set $wp (local.get $w))
        (local.set $wq (i32.add (local.get $w) (local.get $width)))
        (local.set $xp (i32.add (local.get $x) (local.get $at)))
        (local.set $left (local.get $columns))
        (loop $next_column
          (local.set $u (v128.load32_splat (local.get $wp)))
          (local.set $v (v128.load32_splat (local.get $wq)))
          (local.set $t (v128.load (local.get $xp)))
          (local.set $a0 (f32x4.add (local.get $a0) (f32x4.mul (local.get $u) (local.get $t))))
          (local.set $c0 (f32x4.add (local.get $c0) (f32x4.mul (local.get $v) (local.get $t))))
          (local.set $t (v128.load offset=16 (local.get $xp)))
          (local.set $a1 (f32x4.add (local.get $a1) (f32x4.mul (local.get $u) (local.get $t))))
          (local.set $c1 (f32x4.add (local.get $c1) (f32x4.mul (local.get $v) (local.get $t))))
          (local.set $t (v128.load offset=32 (local.get $xp)))
          (local.set $a2 (f32x4.add (local.get $a2) (f32x4.mul (local.get $u) (local.get $t))))
          (local.set $c2 (f32x4.add (local.get $c2) (f32x4.mul (local.get $v) (local.get $t))))
          (local.set $t (v128.load offset=48 (local.get $xp)))
          (local.set $a3 (f32x4.add (local.get $a3) (f32x4.mul (local.get $u) (local.get $t))))
          (local.set $c3 (f32x4.add (local.get $c3) (f32x4.mul (local.get $v) (local.get $t))))
          (local.set $wp (i32.add (local.get $wp) (i32.const 4)))
          (local.set $wq (i32.add (local.get $wq) (i32.const 4)))
          (local.set $xp (i32.add (local.get $xp) (local.get $stride)))
          (local.set $left (i32.sub (local.get $left) (i32.const 1)))
          (br_if $next_column (local.get $left)))
        (local.set $yp (i32.add (local.get $y) (local.get $at)))
        (v128.store (local.get $yp) (local.get $a0))
        (v128.store offset=16 (local.get $yp) (local.get $a1))
        (v128.store offset=32 (local.get $yp) (local.get $a2))
        (v128.store offset=48 (local.get $yp) (local.get $a3))
        (local.set $yp (i32.add (local.get $yp) (local.get $stride)))
        (v128.store (local.get $yp) (local.get $c0))
        (v128.store offset=16 (local.get $yp) (local.get $c1))
        (v128.store offset=32 (local.get $yp) (local.get $c2))
        (v128.store offset=48 (local.get $yp) (local.get $c3))
        (local.set $at (i32.add (local.get $at) (i32.const 64)))
        (br_if $next_points (i32.lt_u (local.get $at) (local.get $stride))))
      (local.set $w (i32.add (local.get $w) (i32.shl (local.get $width) (i32.const 1))))
      (local.set $b (i32.add (local.get $b) (i32.const 8)))
      (local.set $y (i32.add (local.get $y) (i32.shl (local.get $stride) (i32.const 1))))
      (local.set $rows (i32.sub (local.get $rows) (i32.const 2)))
      (br_if $next_rows (i32.gt_s (local.get $rows) (i32.const 0)))))

  ;; Replaces `count` floats t at y by sin(pi t); and where d is not 0 writes the slopes
  ;; pi cos(pi t) there. `count` is a multiple of 4.
  ;;
  ;; t = k + f with a whole k and |f| <= 1/2: adding 1.5 * 2^23 leaves k in the low bits, the lowest
  ;; of which gives the sign. Then sin(pi f) by an odd polynomial of degree 9, 5e-9 off before
  ;; rounding (least largest relative error on the interval).
  (func (export "sine") (param $y i32) (param $d i32) (param $count i32)
    (local $t v128) (local $k v128) (local $f v128) (local $s v128)
    (loop $next
      (local.set $t (v128.load (local.get $y)))
      (local.set $k (f32x4.add (local.get $t) (v128.const f32x4 12582912.0 12582912.0 12582912.0 12582912.0)))
      (local.set $f
        (f32x4.sub (local.get $t) (f32x4.sub (local.get $k) (v128.const f32x4 12582912.0 12582912.0 12582912.0 12582912.0))))
      (local.set $k (i32x4.shl (local.get $k) (i32.const 31)))
      (local.set $s (f32x4.mul (local.get $f) (local.get $f)))
      (v128.store (local.get $y)
        (v128.xor (local.get $k)
          (f32x4.mul (local.get $f)
            (f32x4.add (v128.const f32x4 3.1415927410125732 3.1415927410125732 3.1415927410125732 3.1415927410125732)
            (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 -5.167709827423096 -5.167709827423096 -5.167709827423096 -5.167709827423096)
            (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 2.550069808959961 2.550069808959961 2.550069808959961 2.550069808959961)
            (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 -0.5982421040534973 -0.5982421040534973 -0.5982421040534973 -0.5982421040534973)
            (f32x4.mul (local.get $s) (v128.const f32x4 0.07756038755178452 0.07756038755178452 0.07756038755178452 0.07756038755178452))))))))))))
      (if (local.get $d)
        (then
          ;; cos(pi f) = sin(pi (1/2 - |f|))
          (local.set $f (f32x4.sub (v128.const f32x4 0.5 0.5 0.5 0.5) (f32x4.abs (local.get $f))))
          (local.set $s (f32x4.mul (local.get $f) (local.get $f)))
          (v128.store (local.get $d)
            (v128.xor (local.get $k)
              (f32x4.mul (f32x4.mul (v128.const f32x4 3.1415927410125732 3.1415927410125732 3.1415927410125732 3.1415927410125732) (local.get $f))
                (f32x4.add (v128.const f32x4 3.1415927410125732 3.1415927410125732 3.1415927410125732 3.1415927410125732)
                (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 -5.167709827423096 -5.167709827423096 -5.167709827423096 -5.167709827423096)
                (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 2.550069808959961 2.550069808959961 2.550069808959961 2.550069808959961)
                (f32x4.mul (local.get $s) (f32x4.add (v128.const f32x4 -0.5982421040534973 -0.5982421040534973 -0.5982421040534973 -0.5982421040534973)
                (f32x4.mul (local.get $s) (v128.const f32x4 0.07756038755178452 0.07756038755178452 0.07756038755178452 0.07756038755178452))))))))))))
          (local.set $d (i32.add (local.get $d) (i32.const 16)))))
      (local.set $y (i32.add (local.get $y) (i32.const 16)))
      (local.set $count (i32.sub (local.get $count) (i32.const 4)))
      (br_if $next (i32.gt_s (local.get $count) (i32.const 0)))))

  ;; Multiplies `count` floats at y by those at d. `count` is a multiple of 4.
  (func (export "multiply") (param $y i32) (param $d i32) (param $count i32)
    (loop $next
      (v128.store (local.get $y) (f32x4.mul (v128.load (local.get $y)) (v128.load (local.get $d))))
      (local.set $y (i32.add (local.get $y) (i32.const 16)))
      (local.set $d (i32.add (local.get $d) (i32.const 16)))
      (local.set $count (i32.sub (local.get $count) (i32.const 4)))
      (br_if $next (i32.gt_s (local.get $count) (i32.const 0)))))
)
