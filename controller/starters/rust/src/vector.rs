// SPDX-License-Identifier: BSD-3-Clause
//! Vectors and matrices of three dimensions in f32.
//!
//! The order of each summation is part of the law, because it decides the last bit:
//! - a dot product, a squared length or a matrix product starts at 0 and adds in index order;
//! - a matrix-vector product starts with its first product. This shows in the sign of a zero.

use std::ops::{Add, Div, Index, IndexMut, Mul, Neg, Sub};

/// Three components: {x, y, z}, or {roll, pitch, yaw} about these axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector(pub [f32; 3]);

/// Rows of three columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrix(pub [[f32; 3]; 3]);

/// A Hamilton quaternion {w, x, y, z}.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quaternion(pub [f32; 4]);

/// The nearest f32, same as exp(). The functions of f32 are often off by the last bit.
pub fn atan2(y: f32, x: f32) -> f32 {
    f64::from(y).atan2(f64::from(x)) as f32
}

pub fn exp(x: f32) -> f32 {
    f64::from(x).exp() as f32
}

/// Limits `value` to [low, high]. NaN passes. `f32::clamp` panics on limits that are NaN
/// or swapped, which parameters can cause.
pub fn limited(value: f32, low: f32, high: f32) -> f32 {
    if value < low {
        low
    } else if value > high {
        high
    } else {
        value
    }
}

impl Vector {
    fn from_axes(value: impl Fn(usize) -> f32) -> Self {
        Vector(std::array::from_fn(value))
    }

    pub fn dot(self, other: Self) -> f32 {
        (0..3).fold(0.0, |sum, i| sum + self[i] * other[i])
    }

    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Vector([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn length(self) -> f32 {
        self.dot(self).sqrt()
    }

    /// The element-wise product.
    pub fn times(self, other: Self) -> Self {
        Self::from_axes(|i| self[i] * other[i])
    }

    /// Limits each axis to +-`limit`.
    pub fn limited(self, limit: Self) -> Self {
        Self::from_axes(|i| limited(self[i], -limit[i], limit[i]))
    }
}

impl Index<usize> for Vector {
    type Output = f32;
    fn index(&self, axis: usize) -> &f32 {
        &self.0[axis]
    }
}

impl IndexMut<usize> for Vector {
    fn index_mut(&mut self, axis: usize) -> &mut f32 {
        &mut self.0[axis]
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_axes(|i| self[i] + other[i])
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::from_axes(|i| self[i] - other[i])
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_axes(|i| -self[i])
    }
}

impl Mul<f32> for Vector {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self::from_axes(|i| self[i] * factor)
    }
}

impl Div<f32> for Vector {
    type Output = Self;
    fn div(self, divisor: f32) -> Self {
        Self::from_axes(|i| self[i] / divisor)
    }
}

impl Matrix {
    pub const IDENTITY: Self = Matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    fn from_elements(value: impl Fn(usize, usize) -> f32) -> Self {
        Matrix(std::array::from_fn(|row| std::array::from_fn(|column| value(row, column))))
    }

    /// The matrix K with K * v = `axis` x v.
    pub fn cross_product(axis: Vector) -> Self {
        let [x, y, z] = axis.0;
        Matrix([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    }

    pub fn column(&self, column: usize) -> Vector {
        Vector::from_axes(|row| self.0[row][column])
    }

    pub fn transposed(&self) -> Self {
        Self::from_elements(|row, column| self.0[column][row])
    }
}

impl Add for Matrix {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::from_elements(|row, column| self.0[row][column] + other.0[row][column])
    }
}

impl Mul<f32> for Matrix {
    type Output = Self;
    fn mul(self, factor: f32) -> Self {
        Self::from_elements(|row, column| self.0[row][column] * factor)
    }
}

impl Mul<Matrix> for Matrix {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::from_elements(|row, column| Vector(self.0[row]).dot(other.column(column)))
    }
}

impl Mul<Vector> for Matrix {
    type Output = Vector;
    fn mul(self, v: Vector) -> Vector {
        Vector::from_axes(|i| self.0[i][0] * v[0] + self.0[i][1] * v[1] + self.0[i][2] * v[2])
    }
}

impl Quaternion {
    pub fn conjugate(self) -> Self {
        let [w, x, y, z] = self.0;
        Quaternion([w, -x, -y, -z])
    }

    pub fn imaginary(self) -> Vector {
        let [_, x, y, z] = self.0;
        Vector([x, y, z])
    }

    /// The rotation matrix, body to world if the quaternion is, which is not normalised first.
    pub fn rotation(self) -> Matrix {
        let [a, b, c, d] = self.0;
        let (aa, bb, cc, dd) = (a * a, b * b, c * c, d * d);
        Matrix([
            [aa + bb - cc - dd, 2.0 * (b * c - a * d), 2.0 * (a * c + b * d)],
            [2.0 * (b * c + a * d), aa - bb + cc - dd, 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (a * b + c * d), aa - bb - cc + dd],
        ])
    }

    pub fn from_rotation(matrix: &Matrix) -> Self {
        let d = &matrix.0;
        let trace = d[0][0] + d[1][1] + d[2][2];
        if trace > 0.0 {
            let root = (trace + 1.0).sqrt();
            let s = 0.5 / root;
            return Quaternion([
                root * 0.5,
                (d[2][1] - d[1][2]) * s,
                (d[0][2] - d[2][0]) * s,
                (d[1][0] - d[0][1]) * s,
            ]);
        }
        // Of equal diagonal elements, the first one counts as the largest.
        let i =
            (1..3).fold(0, |largest, k| if d[k][k] > d[largest][largest] { k } else { largest });
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let root = (d[i][i] - d[j][j] - d[k][k] + 1.0).sqrt();
        let s = 0.5 / root;
        let mut q = [0.0; 4];
        q[0] = (d[k][j] - d[j][k]) * s;
        q[1 + i] = root * 0.5;
        q[1 + j] = (d[i][j] + d[j][i]) * s;
        q[1 + k] = (d[k][i] + d[i][k]) * s;
        Quaternion(q)
    }
}

impl Mul for Quaternion {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        Quaternion([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ])
    }
}
