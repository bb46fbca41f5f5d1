//! Campbell diagrams on several threads.

use flexion::analysis::campbell::{Block, Campbell, NoCampbell, Plan, Speeds, assemble};
use flexion::system::Fork;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// Work of an equilibrium that is tried, and of the modes by a mesh of twice as many elements, over that of the modes at one speed.
const EQUILIBRIUM: f64 = 0.125;
const FINER: f64 = 2.0;

/// Computes the diagram of `system` on `threads` threads, 0 for as many as the machine has, each with a fork of it: the same
/// diagram for any number of them. With a finer mesh of the same system, whose differences times `safety` estimate the errors of
/// the frequencies, these are computed too.
/// `progress` is called with the number of speeds that are done and the work since its last call, in that of the modes at one speed, and stops
/// by `false`: the diagram ends there.
///
/// # Errors
/// [`NoCampbell`].
///
/// # Panics
/// Where a thread does.
pub fn campbell(
    system: Box<dyn Fork>,
    finer: Option<(Box<dyn Fork>, f64)>,
    plan: &Plan,
    threads: usize,
    progress: &(dyn Fn(usize, f64) -> bool + Sync),
) -> Result<Campbell, NoCampbell> {
    let (stop, done) = (AtomicBool::new(false), AtomicUsize::new(0));
    let next = |solved: usize, work: f64| {
        if !progress(solved + done.fetch_add(solved, Ordering::Relaxed), work) {
            stop.store(true, Ordering::Relaxed);
        }
        !stop.load(Ordering::Relaxed)
    };
    let (one, again, one_finer) = (|| next(1, 1.0), || next(0, EQUILIBRIUM), || next(0, FINER));
    let (mut speeds, blocks) = computed(system, plan, threads, [&one, &again])?;
    let mut diagram = assemble(&mut speeds, blocks, again)?;
    if let Some((finer, safety)) = finer.filter(|_| diagram.speeds.len() > 1 && again()) {
        let plan = Plan { speeds: diagram.speeds.clone(), ..plan.clone() };
        let (_, blocks) = computed(finer, &plan, threads, [&one_finer, &again])?;
        diagram.compare(blocks.iter().flat_map(Block::modes), safety);
        diagram.unestimated = blocks.iter().find_map(Block::failure).cloned();
    }
    Ok(diagram)
}

/// The modes at all speeds, and the system that found them. Whether it goes on is asked by `solved` behind every speed, and by `again` while one is
/// searched.
fn computed<'p>(
    system: Box<dyn Fork>,
    plan: &'p Plan,
    threads: usize,
    [solved, again]: [&'p (dyn Fn() -> bool + Sync); 2],
) -> Result<(Speeds<'p>, Vec<Block>), NoCampbell> {
    let count = Speeds::blocks(plan);
    let threads = match threads {
        0 => thread::available_parallelism().map_or(1, usize::from),
        n => n,
    };
    let next = AtomicUsize::new(0);
    // Nothing is computed beyond a block that ends.
    let end = AtomicUsize::new(count);
    let blocks: Vec<Mutex<Option<Block>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let work = |speeds: &mut Speeds<'_>| {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = blocks.get(number).filter(|_| number < end.load(Ordering::Relaxed)) else {
                return;
            };
            let block = speeds.block(number, solved);
            if block.ends() {
                end.fetch_min(number, Ordering::Relaxed);
            }
            if let Ok(mut slot) = slot.lock() {
                *slot = Some(block);
            }
        }
    };
    let forks = (1..threads.min(count)).map(|_| Speeds::new(system.fork(), plan, again));
    let others = forks.collect::<Result<Vec<_>, _>>()?;
    let mut speeds = Speeds::new(system, plan, again)?;
    thread::scope(|scope| {
        let work = &work;
        let others = others.into_iter().map(|mut speeds| scope.spawn(move || work(&mut speeds)));
        let others: Vec<_> = others.collect();
        work(&mut speeds);
        for other in others {
            other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
    });
    let blocks = blocks.into_iter().map_while(|slot| slot.into_inner().ok().flatten()).collect();
    Ok((speeds, blocks))
}
