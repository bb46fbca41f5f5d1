//! What is said, drawn and written of a run.

use super::Run;
use crate::reading::Reading;
#[cfg(feature = "figures")]
use flexion_results::plot::{Figure, contact_figure, spatial_figure, trajectory_figure};
use flexion_results::{
    Attachments, Directory, Integration, OutputError, RunReport, Status, Summary, view_run, write_run,
};

impl Reading {
    /// How a run of this case went, as `summary.json` states it.
    pub fn summary(&self, run: &Run) -> Summary {
        let warnings: Vec<String> = run.all_warnings().map(str::to_owned).collect();
        self.report(run, &warnings, |report| Summary::of_run(report, &run.trajectory))
    }

    /// The figure of a run of this case: its principal columns, and the contacts and views that it has.
    #[cfg(feature = "figures")]
    pub fn figure(&self, run: &Run) -> Figure {
        let title = self.title();
        match &run.events {
            events if self.case.space().is_some() => {
                spatial_figure(&run.scene, &run.trajectory, events, title)
            }
            events if events.is_empty() => trajectory_figure(&run.trajectory, title),
            events => contact_figure(&run.scene, &run.trajectory, events, title),
        }
    }

    /// A run of this case as a page plays it, with the usual columns.
    pub fn view(&self, run: &Run) -> serde_json::Value {
        let mut scene = serde_json::Map::new();
        // To a page nothing is refused.
        let _ = run.scene.put(&mut scene);
        let title = self.case.title.as_str();
        let error = |column: usize| run.error_in_time(column);
        view_run((title, title), run.message.as_deref(), &run.trajectory, scene, &[], &error)
            .unwrap_or_default()
    }

    /// Writes the results of a run of this case and publishes them.
    ///
    /// # Errors
    /// [`OutputError`] for whatever goes wrong on disk or in drawing.
    pub fn write(&self, run: &Run, directory: &Directory) -> Result<Status, OutputError> {
        let identity = self.identity();
        #[cfg(feature = "figures")]
        let figure = {
            // Of a beam at one time there is nothing to be drawn against it.
            let moves = run.trajectory.times().len() > 1 || self.case.space().is_some();
            (self.case.output.plots && moves).then(|| self.figure(run))
        };
        let attachments = Attachments {
            #[cfg(feature = "figures")]
            figure: figure.as_ref(),
            tables: &run.tables,
            // What laws of a program remember is in no file.
            state: self.laws().is_empty().then_some((&run.checkpoint, identity.as_str())),
            shapes: run.shapes.as_ref(),
            scene: Some(&run.scene),
            solids: self.case.space().is_some() && self.case.output.vtk.is_some(),
        };
        let case = self.saved();
        let warnings: Vec<String> = run.all_warnings().map(str::to_owned).collect();
        self.report(run, &warnings, |report| {
            write_run(directory, report, &run.trajectory, &case, attachments)
        })
    }

    /// The case as it is written beside its results: without the laws of a program, which it names.
    fn saved(&self) -> String {
        if self.laws().is_empty() {
            return self.resolved_with_copies();
        }
        let names: Vec<&str> = self.laws().iter().map(|law| law.name.as_str()).collect();
        let case = self
            .without_laws()
            .map_or_else(|_| self.resolved_with_copies(), |case| case.resolved_with_copies());
        format!(
            "# The run had laws of a program, which no file holds: {}. This is the case without them.\n{case}",
            names.join(", ")
        )
    }

    /// Lends what is known of a run.
    fn report<T>(&self, run: &Run, warnings: &[String], with: impl FnOnce(&RunReport<'_>) -> T) -> T {
        let file = self.file.file_name().map(|name| name.to_string_lossy());
        with(&RunReport {
            status: run.status,
            message: run.message.as_deref(),
            title: &self.case.title,
            file: file.as_deref(),
            duration: self.case.duration,
            end_time: run.state.t,
            warnings,
            integrator: Integration { info: &run.info, settings: self.settings("integrator") },
            errors: run.errors.as_ref(),
            events: (!run.events.is_empty()).then_some(&run.events),
            counters: run.counters,
            size: run.size,
            wall_time: run.wall_time,
            cpu_time: run.cpu_time,
            preparation: run.preparation,
            laws: &self.laws().iter().map(|law| law.name.clone()).collect::<Vec<_>>(),
        })
    }
}
