//! Formula expressions of two operands.

use sistership_formula::Expr;

pub fn added(a: Expr, b: Expr) -> Expr {
    Expr::Add(Box::new(a), Box::new(b))
}

pub fn subtracted(a: Expr, b: Expr) -> Expr {
    Expr::Subtract(Box::new(a), Box::new(b))
}

pub fn divided(a: Expr, by: f64) -> Expr {
    Expr::Divide(Box::new(a), Box::new(Expr::Number(by)))
}
