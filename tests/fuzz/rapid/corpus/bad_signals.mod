MODULE M
  VAR num n;
  PROC main()
    Set doGripper;
    Set di1;
    WaitDI do1,1;
    WaitDI di0,1;
    SetDO do1025,1;
    WaitDI di1,2;
    IF di1=2 Set do1;
    IF di1>0 Set do1;
    IF di1 Set do1;
    n:=di1;
    IF TestDI(do1) Set do1;
    Set 1;
    Set do01;
  ENDPROC
ENDMODULE
