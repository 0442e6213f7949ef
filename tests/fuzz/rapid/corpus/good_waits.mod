MODULE M
  VAR bool over;
  PROC main()
    WaitDI di1,1;
    WaitDI di2,0;
    WaitDI di3,high\MaxTime:=2\TimeFlag:=over;
    IF over Set do1;
    WaitTime 0;
  ENDPROC
ENDMODULE
